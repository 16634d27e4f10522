// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/common/io/volume_bytes.h"
#include "tetwright/files.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Attributes and encoding of a DICOM file.
struct DicomToWrite {
  int columns = 5, rows = 4, frames = 1;
  std::string transfer_syntax = "1.2.840.10008.1.2.1";
  std::string series = "1.2.3", description = "bone";
  Vec3 position = Vec3::Zero(), along_row = Vec3::UnitX(), along_column = Vec3::UnitY();
  std::string pixel_spacing = "0.5\\0.25";  ///< of rows and of columns
  std::string rescale_slope = {}, rescale_intercept = {};
  std::string photometric = "MONOCHROME2";
  int samples = 1;
  int bits = 16, stored = 0, high = -1;  ///< stored 0: all
  bool is_signed = false;
  bool placed = true;
  /// Text elements by tag, which replace others; an empty text removes the element.
  std::map<std::uint32_t, std::string> others = {};
  /// Sequences by tag: the elements of their items, encoded.
  std::map<std::uint32_t, std::vector<std::string>> sequences = {};
  std::vector<std::string> fragments = {};  ///< compressed frames; empty: `pixels` are not compressed
  bool without_pixels = false;
};

/// An element in explicit or implicit encoding.
class DicomEncoder {
 public:
  explicit DicomEncoder(const std::string& transfer_syntax)
      : explicit_(transfer_syntax != "1.2.840.10008.1.2"), big_(transfer_syntax == "1.2.840.10008.1.2.2") {}

  std::string element(std::uint32_t tag, const std::string& type, std::string value) const {
    if (value.size() % 2 == 1) value += type == "UI" || type == "OB" ? '\0' : ' ';
    return header(tag, type, static_cast<std::uint32_t>(value.size())) + value;
  }
  std::string number(std::uint32_t tag, int value) const {
    return element(tag, "US", bytes_of<std::uint16_t>({static_cast<std::uint16_t>(value)}, big_));
  }
  /// A sequence of items; `open`: of undefined length.
  std::string sequence(std::uint32_t tag, const std::vector<std::string>& items, bool open = true) const {
    std::string all;
    for (const std::string& item : items)
      all += tag_of(0xfffee000) + number32(open ? 0xffffffff : static_cast<std::uint32_t>(item.size())) +
             item + (open ? tag_of(0xfffee00d) + number32(0) : std::string());
    if (open) return header(tag, "SQ", 0xffffffff) + all + tag_of(0xfffee0dd) + number32(0);
    return header(tag, "SQ", static_cast<std::uint32_t>(all.size())) + all;
  }
  std::string fragments(const std::vector<std::string>& of) const {
    std::string all = header(0x7fe00010, "OB", 0xffffffff) + tag_of(0xfffee000) + number32(0);
    for (std::string fragment : of) {
      if (fragment.size() % 2 == 1) fragment += '\0';
      all += tag_of(0xfffee000) + number32(static_cast<std::uint32_t>(fragment.size())) + fragment;
    }
    return all + tag_of(0xfffee0dd) + number32(0);
  }
  bool big() const { return big_; }

 private:
  std::string number32(std::uint32_t n) const { return bytes_of<std::uint32_t>({n}, big_); }
  std::string tag_of(std::uint32_t tag) const {
    return bytes_of<std::uint16_t>(
        {static_cast<std::uint16_t>(tag >> 16), static_cast<std::uint16_t>(tag & 0xffff)}, big_);
  }
  std::string header(std::uint32_t tag, const std::string& type, std::uint32_t length) const {
    if (!explicit_) return tag_of(tag) + number32(length);
    if (type == "OB" || type == "OW" || type == "SQ" || type == "OF")
      return tag_of(tag) + type + std::string(2, '\0') + number32(length);
    return tag_of(tag) + type + bytes_of<std::uint16_t>({static_cast<std::uint16_t>(length)}, big_);
  }

  bool explicit_, big_;
};

inline std::string dicom_text(const Vec3& v) {
  return std::to_string(v[0]) + "\\" + std::to_string(v[1]) + "\\" + std::to_string(v[2]);
}

/// The bytes of a DICOM file.
/// \param pixels of all frames, encoded
inline std::string dicom_file(const DicomToWrite& file, const std::string& pixels) {
  const DicomEncoder meta("1.2.840.10008.1.2.1"), data(file.transfer_syntax);
  std::map<std::uint32_t, std::pair<std::string, std::string>> texts{
      {0x00080060, {"CS", "CT"}},
      {0x0008103e, {"LO", file.description}},
      {0x0020000e, {"UI", file.series}},
      {0x00280004, {"CS", file.photometric}},
      {0x00280030, {"DS", file.pixel_spacing}},
      {0x00281052, {"DS", file.rescale_intercept}},
      {0x00281053, {"DS", file.rescale_slope}}};
  if (file.frames > 1) texts[0x00280008] = {"IS", std::to_string(file.frames)};
  if (file.placed) {
    texts[0x00200032] = {"DS", dicom_text(file.position)};
    texts[0x00200037] = {"DS", dicom_text(file.along_row) + "\\" + dicom_text(file.along_column)};
  }
  for (const auto& [tag, text] : file.others) texts[tag] = {"DS", text};
  std::map<std::uint32_t, std::string> elements;
  for (const auto& [tag, text] : texts)
    if (!text.second.empty()) elements[tag] = data.element(tag, text.first, text.second);
  const int stored = file.stored > 0 ? file.stored : file.bits;
  const std::map<std::uint32_t, int> numbers{{0x00280002, file.samples},
                                             {0x00280010, file.rows},
                                             {0x00280011, file.columns},
                                             {0x00280100, file.bits},
                                             {0x00280101, stored},
                                             {0x00280102, file.high >= 0 ? file.high : stored - 1},
                                             {0x00280103, file.is_signed ? 1 : 0}};
  for (const auto& [tag, number] : numbers) elements[tag] = data.number(tag, number);
  for (const auto& [tag, items] : file.sequences) elements[tag] = data.sequence(tag, items);
  if (!file.without_pixels)
    elements[0x7fe00010] = file.fragments.empty()
                               ? data.element(0x7fe00010, file.bits == 8 ? "OB" : "OW", pixels)
                               : data.fragments(file.fragments);
  std::string group = meta.element(0x00020010, "UI", file.transfer_syntax);
  std::string out = std::string(128, '\0') + "DICM" +
                    meta.element(0x00020000, "UL",
                                 bytes_of<std::uint32_t>({static_cast<std::uint32_t>(group.size())}, false)) +
                    group;
  for (const auto& [tag, element] : elements) out += element;
  return out;
}

/// Numbers of pixels, encoded for a file.
template <class Number>
std::string dicom_pixels(const std::vector<Number>& numbers, const DicomToWrite& file) {
  return bytes_of(numbers, file.transfer_syntax == "1.2.840.10008.1.2.2");
}

}  // namespace tetwright
