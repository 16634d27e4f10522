// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/text/text_scanner.h"
#include "tetwright/io.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Sections common to legacy VTK files of all datasets: header, points, lists of cells, fields. A reader
/// derives from it and calls read_sections(). Functions that read throw InputErrors with the line.
class VtkSections {
 protected:
  enum class Data { none, points, cells };

  /// A list of cells: the points of cell c begin at points[offsets[c]].
  class Cells {
   public:
    std::size_t count() const { return offsets_.empty() ? 0 : offsets_.size() - 1; }
    std::size_t size(std::size_t cell) const {
      return static_cast<std::size_t>(offsets_[cell + 1] - offsets_[cell]) - before_each_;
    }
    std::size_t begin(std::size_t cell) const { return static_cast<std::size_t>(offsets_[cell]); }
    /// Point at a position of the list; it may not exist.
    std::int64_t point(std::size_t place) const { return points_[place]; }
    void free_points() { points_ = {}; }

   private:
    friend class VtkSections;
    std::vector<std::int64_t> offsets_, points_;
    std::size_t before_each_ = 0;  ///< numbers before the points of each cell: in old files its size
  };

  VtkSections(std::string_view bytes, const std::string& name) : in_(bytes, name) {}
  ~VtkSections() = default;

  /// Reads the header and all sections, and appends the dropped contents.
  void read_sections(std::vector<Dropped>& dropped);

  /// Reads a section that this class does not read itself.
  /// \param part keyword in lower case
  /// \return false if there is no such section
  virtual bool read_section(const std::string& part) = 0;
  /// Fails if this reader does not support the dataset.
  /// \param word word after DATASET, in lower case
  virtual void check_dataset(std::string_view word) = 0;
  /// Number of cells; called at the beginning of their data.
  virtual std::size_t cell_count() = 0;
  virtual void take_field(Data data, MeshField field) = 0;
  /// Receives an array of the whole dataset.
  /// \return false to drop it
  virtual bool take_dataset_array(const std::string& name, const std::vector<double>& values) = 0;

  /// Reads the list of cells after its keyword.
  /// \param begin becomes the position of the first number, for fail_at()
  Cells read_cells(const std::string& keyword, TextScanner& begin);
  /// Reads a count and as many numbers.
  /// \param begin as for read_cells()
  std::vector<std::int64_t> read_whole_numbers(const char* count_of, const char* what, TextScanner& begin);
  /// Checks and returns the point at a position of a list of cells that begins at `begin`.
  Index checked_point(const Cells& cells, std::size_t cell, std::size_t place,
                      const TextScanner& begin) const;
  /// \throws InputError with the line of the k-th number of a list that begins at `begin`
  [[noreturn]] void fail_at(TextScanner begin, std::size_t k, const std::string& message) const;

  TextScanner in_;
  std::string_view title_;  ///< second line of the file
  std::vector<Vec3> points_;
  bool has_points_ = false;

 private:
  void read_head();
  void read_part(const std::string& part, std::string_view word);
  void read_points();
  std::string type_word();
  std::string name_word();
  void expect_word(const char* expected);
  void begin_data(Data data);
  void add_field(const std::string& name, std::size_t components, const std::string& type);
  std::size_t checked_components(std::int64_t n) const;
  bool read_attribute(const std::string& part);
  void read_scalars_head(std::size_t& components);
  void skip_colours(std::size_t n, std::size_t components);
  void read_field();
  void skip_metadata();

  bool binary_ = false;
  Data data_ = Data::none;
  std::size_t items_ = 0;                                            ///< number of points or cells with data
  std::vector<std::string> dataset_arrays_, text_arrays_, colours_;  ///< names of ignored arrays
  KindCounts rounded_;                                               ///< rounded integers of fields
};

}  // namespace tetwright
