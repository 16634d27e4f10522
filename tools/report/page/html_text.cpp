// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/html_text.h"

#include <charconv>

#include "common/io/text/xml_text.h"
#include "common/utf8.h"

namespace tetwright {

std::string html_text(std::string_view text) { return xml_text(printable_name(std::string(text))); }

std::string script_json(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else if (c == '>')
      out += "\\u003e";
    else
      out += c;
  }
  return out;
}

std::string fixed_number(double value, int decimals) {
  char buffer[400];  // the longest double has 309 digits before the point
  return {buffer,
          std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr};
}

std::string grouped_number(std::size_t value) {
  std::string out = std::to_string(value);
  for (std::size_t at = out.size(); at > 3;) out.insert(at -= 3, ",");
  return out;
}

}  // namespace tetwright
