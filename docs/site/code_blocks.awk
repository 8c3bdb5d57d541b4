#!/usr/bin/awk -f
# Prints the code blocks of one language of a page, one after the other: code_blocks.awk -v language=cpp PAGE
/^```/ {
  block = block == "" ? substr($0, 4) : ""
  next
}
block == language && language != ""
