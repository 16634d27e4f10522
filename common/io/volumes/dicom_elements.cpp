// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/dicom_elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/message_text.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::uint64_t preamble_bytes = 128;
constexpr std::string_view magic = "DICM";
constexpr std::uint32_t undefined_length = 0xffffffff;
constexpr std::uint32_t item_tag = 0xfffee000, item_end = 0xfffee00d, sequence_end = 0xfffee0dd;
constexpr std::uint32_t class_tag = 0x00020002, transfer_syntax_tag = 0x00020010;
constexpr std::string_view directory_class = "1.2.840.10008.1.3.10";
constexpr std::string_view implicit_little = "1.2.840.10008.1.2", explicit_big = "1.2.840.10008.1.2.2",
                           deflated = "1.2.840.10008.1.2.1.99",
                           ge_big_pixels = "1.2.840.113619.5.2";  // implicit, pixels alone in big endian

/// Nested sequences; files have some five at most.
constexpr int max_depth = 32;

/// Longest value that is kept; those of DICOM's strings of numbers have some kilobytes.
constexpr std::uint32_t max_value_bytes = std::uint32_t{1} << 22;

constexpr std::array kept_values{dicom::series_description.tag,
                                 dicom::spacing_between_slices.tag,
                                 dicom::series_instance_uid.tag,
                                 dicom::series_number.tag,
                                 dicom::image_position.tag,
                                 dicom::image_orientation.tag,
                                 dicom::samples_per_pixel.tag,
                                 dicom::photometric_interpretation.tag,
                                 dicom::number_of_frames.tag,
                                 dicom::rows.tag,
                                 dicom::columns.tag,
                                 dicom::pixel_spacing.tag,
                                 dicom::bits_allocated.tag,
                                 dicom::bits_stored.tag,
                                 dicom::high_bit.tag,
                                 dicom::pixel_representation.tag,
                                 dicom::rescale_intercept.tag,
                                 dicom::rescale_slope.tag,
                                 dicom::grid_frame_offsets.tag,
                                 dicom::dose_grid_scaling.tag};
constexpr std::array kept_sequences{dicom::plane_position.tag,
                                    dicom::plane_orientation.tag,
                                    dicom::modality_lut.tag,
                                    dicom::pixel_measures.tag,
                                    dicom::pixel_value_transformation.tag,
                                    dicom::shared_functional_groups.tag,
                                    dicom::per_frame_functional_groups.tag};

template <class Tags>
bool has_tag(const Tags& tags, std::uint32_t tag) {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

bool has_long_length(std::string_view type) {
  constexpr std::array<std::string_view, 13> types{"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                   "SV", "UC", "UN", "UR", "UT", "UV"};
  return std::find(types.begin(), types.end(), type) != types.end();
}

std::string without_padding(const std::string& value) {
  return std::string(trimmed(std::string_view(value).substr(0, value.find('\0'))));
}

std::string tag_text(std::uint32_t tag) {
  char text[16];
  std::snprintf(text, sizeof text, "(%04x,%04x)", tag >> 16, tag & 0xffff);
  return text;
}

/// Small ranges of a file, read by blocks.
class BlockReader {
 public:
  explicit BlockReader(const ByteRanges& file) : file_(file) {}

  /// \param n at most block_bytes
  /// \pre the file has these bytes
  const char* at(std::uint64_t offset, std::size_t n) {
    if (offset < begin_ || offset + n > begin_ + block_.size) {
      begin_ = offset;
      block_ = file_.bytes(offset, static_cast<std::size_t>(std::min<std::uint64_t>(std::max(n, block_bytes),
                                                                                    file_.size() - offset)));
    }
    return block_.data.get() + (offset - begin_);
  }

 private:
  static constexpr std::size_t block_bytes = std::size_t{1} << 13;
  const ByteRanges& file_;
  std::uint64_t begin_ = 0;
  ByteBuffer block_;
};

}  // namespace

bool DicomItem::has(const DicomAttribute& attribute) const {
  return values_.contains(attribute.tag) || sequences_.contains(attribute.tag);
}

std::string DicomItem::text(const DicomAttribute& attribute) const {
  const auto found = values_.find(attribute.tag);
  return found == values_.end() ? std::string() : without_padding(found->second);
}

std::vector<double> DicomItem::numbers(const DicomAttribute& attribute, std::size_t count,
                                       const std::string& file) const {
  const std::string value = text(attribute);
  std::vector<double> out;
  if (value.empty()) return out;
  std::string_view rest = value;
  bool more = true, good = true;
  while (more && good) {
    const std::size_t end = rest.find('\\');
    more = end != std::string_view::npos;
    std::string_view word = trimmed(rest.substr(0, end));
    if (word.starts_with('+')) word.remove_prefix(1);
    good = parse_number(word, out.emplace_back()) && std::isfinite(out.back());
    if (more) rest.remove_prefix(end + 1);
  }
  if (!good || (count > 0 && out.size() != count))
    throw InputError(file, 0,
                     std::string(attribute.keyword) + " is " + in_quotes(value) + ", not " +
                         (count == 0   ? "finite numbers"
                          : count == 1 ? "a finite number"
                                       : std::to_string(count) + " finite numbers") +
                         "; export the series again");
  return out;
}

std::uint16_t DicomItem::number(const DicomAttribute& attribute, std::uint16_t otherwise,
                                const std::string& file) const {
  const auto found = values_.find(attribute.tag);
  if (found == values_.end() || found->second.empty()) return otherwise;
  if (found->second.size() != sizeof(std::uint16_t))
    throw InputError(file, 0,
                     std::string(attribute.keyword) + " has " + std::to_string(found->second.size()) +
                         " bytes instead of 2; export the series again");
  return load<std::uint16_t>(found->second.data(), swap_);
}

const std::vector<DicomItem>& DicomItem::items(const DicomAttribute& sequence) const {
  static const std::vector<DicomItem> none;
  const auto found = sequences_.find(sequence.tag);
  return found == sequences_.end() ? none : found->second;
}

/// Walks through the elements of a file.
class DicomScan {
 public:
  explicit DicomScan(const ByteRanges& file) : file_(file), reader_(file), size_(file.size()) {}

  DicomStructure scan() {
    if (size_ < preamble_bytes + magic.size() ||
        std::string_view(reader_.at(preamble_bytes, magic.size()), magic.size()) != magic)
      throw InputError(file_.name(), 0,
                       "it is no DICOM file: \"DICM\" is missing at byte 128; copy or export it again, or "
                       "remove it from the folder");
    scan_meta_information();
    const std::string& syntax = out_.transfer_syntax;
    if (syntax == deflated)
      throw InputError(file_.name(), 0,
                       "its whole content is deflated, and only pixels may be compressed; convert it, for "
                       "example by gdcmconv --raw");
    encoding_.explicit_types = syntax != implicit_little && syntax != ge_big_pixels && !syntax.empty();
    encoding_.big_endian = syntax == explicit_big;
    out_.big_endian_pixels = encoding_.big_endian || syntax == ge_big_pixels;
    (void)scan_elements(position_, size_, encoding_, &out_.attributes, 0);
    return std::move(out_);
  }

 private:
  struct Encoding {
    bool explicit_types = true, big_endian = false;
    bool swap() const { return big_endian == little_endian_machine; }
  };

  struct Element {
    std::uint32_t tag = 0, length = 0;
    std::string type;         ///< two letters, or empty
    std::uint64_t value = 0;  ///< its offset
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file_.name(), 0, what + "; the file is truncated or damaged, copy or export it again");
  }

  template <class Number>
  Number load_at(std::uint64_t offset, const Encoding& encoding) {
    return load<Number>(reader_.at(offset, sizeof(Number)), encoding.swap());
  }

  std::uint32_t tag_at(std::uint64_t at, const Encoding& encoding) {
    return std::uint32_t{load_at<std::uint16_t>(at, encoding)} << 16 |
           load_at<std::uint16_t>(at + 2, encoding);
  }

  /// Reads tag, type and length of an element that ends before `end`.
  Element element_at(std::uint64_t at, std::uint64_t end, const Encoding& encoding) {
    constexpr std::uint64_t short_header = 8, long_header = 12;
    const auto need = [&](std::uint64_t bytes) {
      if (end - at < bytes)
        fail("an element at byte " + std::to_string(at) + " has no room before byte " + std::to_string(end));
    };
    need(short_header);
    Element element{tag_at(at, encoding), 0, {}, at + short_header};
    const bool delimiter = element.tag == item_tag || element.tag == item_end || element.tag == sequence_end;
    if (!encoding.explicit_types || delimiter) {
      element.length = load_at<std::uint32_t>(at + 4, encoding);
      return element;
    }
    element.type.assign(reader_.at(at + 4, 2), 2);
    if (!std::all_of(element.type.begin(), element.type.end(), [](char c) { return c >= 'A' && c <= 'Z'; }))
      fail("the element " + tag_text(element.tag) + " at byte " + std::to_string(at) + " has the type " +
           in_quotes(element.type));
    if (!has_long_length(element.type)) {
      element.length = load_at<std::uint16_t>(at + 6, encoding);
      return element;
    }
    need(long_header);
    element.length = load_at<std::uint32_t>(at + 8, encoding);
    element.value = at + long_header;
    return element;
  }

  void check_inside(const Element& element, std::uint64_t end) const {
    if (element.length > end - element.value)
      fail("the element " + tag_text(element.tag) + " has " + std::to_string(element.length) +
           " bytes from byte " + std::to_string(element.value) + " on, and only " +
           std::to_string(end - element.value) + " are there");
  }

  std::string value_of(const Element& element) const {
    if (element.length > max_value_bytes)
      fail("the element " + tag_text(element.tag) + " has " + std::to_string(element.length) + " bytes");
    std::string value(element.length, '\0');
    file_.read(element.value, value.data(), value.size());
    return value;
  }

  /// Reads the group 2, which is always explicit and little endian.
  void scan_meta_information() {
    position_ = preamble_bytes + magic.size();
    const Encoding encoding;
    while (size_ - position_ >= 2 && load_at<std::uint16_t>(position_, encoding) == 2) {
      const Element element = element_at(position_, size_, encoding);
      check_inside(element, size_);
      if (element.tag == class_tag) out_.is_directory = without_padding(value_of(element)) == directory_class;
      if (element.tag == transfer_syntax_tag) out_.transfer_syntax = without_padding(value_of(element));
      position_ = element.value + element.length;
    }
  }

  /// Walks through elements up to `end`, or to the end of their item.
  /// \param into receives attributes; null: they are skipped
  /// \param depth number of sequences around them; 0: stops at the pixels
  /// \return the offset of what follows
  std::uint64_t scan_elements(std::uint64_t at, std::uint64_t end, const Encoding& encoding, DicomItem* into,
                              int depth) {
    if (into) into->swap_ = encoding.swap();
    while (at < end) {
      const Element element = element_at(at, end, encoding);
      if (depth > 0 && element.tag == item_end) return element.value;
      if (depth == 0 && is_pixels(element.tag)) {
        take_pixels(element, encoding);
        return end;
      }
      const bool kept = into && has_tag(kept_sequences, element.tag);
      if (element.length == undefined_length || kept || element.type == "SQ") {
        at = scan_sequence(element, end, encoding, kept ? &into->sequences_[element.tag] : nullptr, depth);
        continue;
      }
      check_inside(element, end);
      if (into && has_tag(kept_values, element.tag)) into->values_[element.tag] = value_of(element);
      at = element.value + element.length;
    }
    return at;
  }

  /// Walks through the items of a sequence.
  std::uint64_t scan_sequence(const Element& sequence, std::uint64_t end, Encoding encoding,
                              std::vector<DicomItem>* into, int depth) {
    if (depth == max_depth) fail("more than " + std::to_string(max_depth) + " sequences are nested");
    const bool open = sequence.length == undefined_length;
    if (!open) {
      check_inside(sequence, end);
      end = sequence.value + sequence.length;
    }
    // Items of type OB are the fragments of an icon. Unknown sequences are always implicit and little endian.
    const bool fragments = sequence.type == "OB" || sequence.type == "OW";
    if (sequence.type == "UN") encoding = {.explicit_types = false, .big_endian = false};
    std::uint64_t at = sequence.value;
    while (open || at < end) {
      const Element item = element_at(at, end, encoding);
      if (item.tag == sequence_end) return item.value;
      if (item.tag != item_tag)
        fail("the sequence " + tag_text(sequence.tag) + " has the element " + tag_text(item.tag) +
             " instead of an item at byte " + std::to_string(at));
      const bool open_item = item.length == undefined_length;
      if (!open_item) check_inside(item, end);
      const std::uint64_t item_stop = open_item ? end : item.value + item.length;
      if (fragments)
        at = item_stop;
      else
        at =
            scan_elements(item.value, item_stop, encoding, into ? &into->emplace_back() : nullptr, depth + 1);
    }
    return at;
  }

  static bool is_pixels(std::uint32_t tag) {
    return tag == dicom::pixel_data.tag || tag == dicom::float_pixel_data.tag ||
           tag == dicom::double_pixel_data.tag;
  }

  void take_pixels(const Element& element, const Encoding& encoding) {
    DicomPixels& pixels = out_.pixels;
    pixels.tag = element.tag;
    pixels.words = !encoding.explicit_types || element.type == "OW";
    pixels.encapsulated = element.length == undefined_length;
    if (!pixels.encapsulated) {
      check_inside(element, size_);
      pixels.ranges.push_back({element.value, element.length});
      return;
    }
    // Some files lack the end of the sequence behind their last fragment.
    for (std::uint64_t at = element.value; at < size_;) {
      const Element item = element_at(at, size_, encoding);
      if (item.tag == sequence_end) break;
      if (item.tag != item_tag)
        fail("its pixels have the element " + tag_text(item.tag) + " instead of a fragment at byte " +
             std::to_string(at));
      check_inside(item, size_);
      pixels.ranges.push_back({item.value, item.length});
      at = item.value + item.length;
    }
  }

  const ByteRanges& file_;
  BlockReader reader_;
  std::uint64_t size_, position_ = 0;
  Encoding encoding_;
  DicomStructure out_;
};

bool is_dicom_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    const FileRanges file(path);
    return file.size() >= preamble_bytes + magic.size() &&
           file.bytes(preamble_bytes, magic.size()).view() == magic;
  } catch (const InputError&) {
    return false;
  }
}

DicomStructure read_dicom_structure(const ByteRanges& file) { return DicomScan(file).scan(); }

}  // namespace tetwright
