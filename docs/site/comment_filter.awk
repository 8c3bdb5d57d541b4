#!/usr/bin/awk -f
# Turns the plain comments of a public header into Doxygen's: a comment above a name, one behind it that may go on below, and
# the one at the top, which is the file's. A code example, indented by three or more, stays as it is written. What is private is
# left out.
function text(comment) {
  gsub(/[\\@]/, "\\\\&", comment)
  gsub(/</, "\\\\<", comment)
  gsub(/>/, "\\\\>", comment)
  gsub(/#/, "\\\\#", comment)
  gsub(/%/, "\\\\%", comment)
  gsub(/[A-Z][a-z]+: /, "%&", comment)  # a word, not the name of a type
  while (match(comment, /`[^`]+`/)) {
    comment = substr(comment, 1, RSTART - 1) "<tt>" substr(comment, RSTART + 1, RLENGTH - 2) "</tt>" \
              substr(comment, RSTART + RLENGTH)
  }
  return comment
}
/^ private:$/ { private = 1 }
/^};/ { private = 0 }
private { print ""; next }
FNR == 1 { print "/// \\file"; top = 1 }
{
  at = match($0, /\/\/( |$)/)
  comment = substr($0, at + 2)
  alone = substr($0, 1, at - 1) ~ /^ *$/
  is_code = comment ~ /^   /
}
example && !(at && alone && is_code) { print "/// \\endverbatim"; example = 0 }
/^#/ || /^}/ || /NOLINT/ || at == 0 { print; behind = 0; next }
!alone { print substr($0, 1, at - 1) "///<" text(comment); behind = at; next }
behind == at { print substr($0, 1, at - 1) "///<" text(comment); next }
comment ~ /^ ----/ { print ""; behind = 0; next }
is_code {
  if (!example) print "/// \\verbatim"
  example = 1
  print "///" comment
  next
}
{ print substr($0, 1, at - 1) "///" text(comment); behind = 0 }
