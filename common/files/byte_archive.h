// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "tetwright/error.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Whether T is the type Of, const or not: for functions archive(), which pass all members of a value to a
/// writer or a reader in a fixed order.
template <class T, class Of>
concept IsType = std::same_as<std::remove_const_t<T>, Of>;

template <class Archive, IsType<InterfaceTriangle> T>
void archive(Archive& members, T& triangle) {
  members(triangle.ids, triangle.material, triangle.other, triangle.patch);
}

template <class Archive, IsType<SurfaceRegion> T>
void archive(Archive& members, T& region) {
  members(region.number, region.name);
}

template <class Archive, IsType<MeshField> T>
void archive(Archive& members, T& field) {
  members(field.name, field.components, field.integer, field.values);
}

template <class Archive, IsType<TetMesh> T>
void archive(Archive& members, T& mesh) {
  members(mesh.points, mesh.tets, mesh.materials, mesh.material_names, mesh.interfaces, mesh.patch_groups,
          mesh.point_fields, mesh.cell_fields);
}

template <class Archive, IsType<MidsideNodes> T>
void archive(Archive& members, T& nodes) {
  members(nodes.edges, nodes.points, nodes.of_tets, nodes.of_faces);
}

/// Adds values to a string of bytes, for files and messages of the same version of the program on machines of
/// the same byte order: numbers, arrays, standard containers, and types with a function archive().
class ByteWriter {
 public:
  template <class... Values>
  void operator()(const Values&... values) {
    (add(values), ...);
  }
  std::string bytes;

 private:
  template <class Value>
  static constexpr bool has_archive = requires(ByteWriter& w, const Value& v) {
    archive(w, v);
  };
  template <class Value>
  static constexpr bool is_plain =
      !has_archive<Value> && (std::is_trivially_copyable_v<Value> || std::same_as<Value, Vec3>);

  void add_raw(const void* values, std::size_t size) { bytes.append(static_cast<const char*>(values), size); }
  template <class Value>
  void add(const Value& value) {
    if constexpr (has_archive<Value>) {
      archive(*this, value);
    } else {
      static_assert(is_plain<Value>);
      add_raw(&value, sizeof value);
    }
  }
  void add(const std::string& text) {
    add(text.size());
    bytes += text;
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(values.size());
    if constexpr (is_plain<Value>)
      add_raw(values.data(), values.size() * sizeof(Value));
    else
      for (const Value& value : values) add(value);
  }
  template <class First, class Second>
  void add(const std::pair<First, Second>& pair) {
    (*this)(pair.first, pair.second);
  }
  template <class Value>
  void add(const std::optional<Value>& value) {
    (*this)(value.has_value(), value.value_or(Value{}));
  }
  template <class Key, class Value>
  void add(const std::map<Key, Value>& map) {
    add(map.size());
    for (const auto& [key, value] : map) (*this)(key, value);
  }
};

/// Takes the values in the same order.
class ByteReader {
 public:
  /// \param bytes must outlive this object
  /// \param name where they come from, for messages
  /// \param incomplete message of the InputError that is thrown if there are too few
  ByteReader(std::string_view bytes, std::string name, std::string incomplete)
      : left_(bytes), name_(std::move(name)), incomplete_(std::move(incomplete)) {}
  template <class... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }
  bool at_end() const { return left_.empty(); }

 private:
  /// Bytes that items of lists have nearly always: a damaged number of them must not ask for memory.
  static constexpr std::size_t min_item = 8;
  template <class Value>
  static constexpr bool has_archive = requires(ByteReader& r, Value& v) {
    archive(r, v);
  };
  template <class Value>
  static constexpr bool is_plain =
      !has_archive<Value> && (std::is_trivially_copyable_v<Value> || std::same_as<Value, Vec3>);

  [[noreturn]] void fail() const { throw InputError(name_, 0, incomplete_); }
  void copy(void* to, std::size_t size) {
    if (size > left_.size()) fail();
    if (size > 0) std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }
  /// A number of items with at least so many bytes each: a damaged one must not ask for memory.
  std::size_t count(std::size_t bytes_each) {
    std::size_t size = 0;
    copy(&size, sizeof size);
    if (size > left_.size() / bytes_each) fail();
    return size;
  }
  template <class Value>
  void take(Value& value) {
    if constexpr (has_archive<Value>) {
      archive(*this, value);
    } else if constexpr (std::same_as<Value, bool>) {
      std::uint8_t byte = 0;  // any other value than 0 and 1 would be undefined behaviour
      copy(&byte, sizeof byte);
      if (byte > 1) fail();
      value = byte == 1;
    } else {
      static_assert(is_plain<Value>);
      copy(static_cast<void*>(&value), sizeof value);
    }
  }
  void take(std::string& text) {
    text.resize(count(1));
    copy(text.data(), text.size());
  }
  template <class Value>
  void take(std::vector<Value>& values) {
    if constexpr (is_plain<Value>) {
      values.resize(count(sizeof(Value)));
      copy(static_cast<void*>(values.data()), values.size() * sizeof(Value));
    } else {
      std::size_t n = count(1);
      values.clear();
      values.reserve(std::min(n, left_.size() / min_item));
      for (; n > 0; --n) take(values.emplace_back());
    }
  }
  template <class First, class Second>
  void take(std::pair<First, Second>& pair) {
    (*this)(pair.first, pair.second);
  }
  template <class Value>
  void take(std::optional<Value>& value) {
    bool there = false;
    Value read{};
    (*this)(there, read);
    if (there)
      value = std::move(read);
    else
      value.reset();
  }
  template <class Key, class Value>
  void take(std::map<Key, Value>& map) {
    map.clear();
    for (std::size_t n = count(1); n > 0; --n) {
      Key key{};
      take(key);
      take(map[key]);
    }
  }

  std::string_view left_;
  std::string name_, incomplete_;
};

}  // namespace tetwright
