// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace tetwright::python {

namespace py = pybind11;

/// Converts to Python text. Names of files need not be UTF-8, but Python's text is.
inline py::str to_text(const std::string& text) {
  PyObject* made = PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace");
  if (!made) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(made);
}

inline py::list to_texts(const std::vector<std::string>& all) {
  py::list texts;
  for (const std::string& text : all) texts.append(to_text(text));
  return texts;
}

}  // namespace tetwright::python
