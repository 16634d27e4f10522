# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a C++ file with the contents of files as the string_views of embedded.h.
#   cmake -DOUTPUT=FILE -DNAMES=page_html;... -DFILES=page.html;... -P embed.cmake
# Raw string literals compile in no time, however long they are; the delimiter is in none of the files.
set(delimiter "embedded_file")
set(text "#include \"tools/report/page/embedded.h\"\n\nnamespace tetwright::embedded {\n\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
  file(READ "${file}" content)
  string(REGEX REPLACE "^(//|/\\*) SPDX-License-Identifier[^\n]*\n" "" content "${content}")
  string(FIND "${content}" ")${delimiter}\"" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${file} has the delimiter of its own string literal in it")
  endif()
  string(APPEND text "const std::string_view ${name} = R\"${delimiter}(${content})${delimiter}\";\n")
endforeach()
string(APPEND text "\n}  // namespace tetwright::embedded\n")
file(WRITE "${OUTPUT}" "${text}")
