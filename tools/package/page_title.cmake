# SPDX-License-Identifier: Apache-2.0
# help2man names a page after the program's file; pages of commands are named like "tetwright-mesh".
file(READ ${FILE} page)
string(REPLACE " " "-" name "${CALL}")
string(TOUPPER "${name}" title)
string(REPLACE "-" "\\\\-" escaped "${name}")  # the replacement below removes one backslash
string(REGEX REPLACE "\n\\.TH [^ ]+ " "\n.TH ${title} " page "${page}")
string(REGEX REPLACE "\n\\.SH NAME\n[^\n]* \\\\- " "\n.SH NAME\n${escaped} \\\\- " page "${page}")
file(WRITE ${FILE} "${page}")
