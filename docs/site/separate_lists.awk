#!/usr/bin/awk -f
# Puts an empty line between a paragraph and the list under it, without which MkDocs takes both for one paragraph.
FNR == 1 { code = list = 0; last = "" }
/^ *```/ { code = !code }
/^$/ { list = 0 }
{
  item = !code && /^([-*]|[0-9]+\.) /
  if (item && !list && last != "") print ""
  if (item) list = 1
  print
  last = $0
}
