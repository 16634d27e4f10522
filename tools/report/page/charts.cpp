// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

#include "tools/report/page/html_text.h"

namespace tetwright {

namespace {

/// Lengths in a drawing are its own units, pixels where the page is wide enough; one decimal is enough.
std::string length(double value) {
  std::string out = fixed_number(value, 1);
  if (out.ends_with(".0")) out.resize(out.size() - 2);
  return out;
}

/// The rectangle that a chart draws in, with room for the labels of its axes around it.
struct Plot {
  static constexpr double left = 46, top = 10, right = 12, bottom = 38;
  double width, height;

  std::string begin(const std::string& label) const {
    return "<svg viewBox=\"0 0 " + length(left + width + right) + " " + length(top + height + bottom) +
           "\" role=\"img\" aria-label=\"" + html_text(label) + "\">";
  }
  double x(double share) const { return left + share * width; }
  double y(double share) const { return top + (1 - share) * height; }
};

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + length(x) + "\" y=\"" + length(y) + "\" text-anchor=\"" + anchor + "\">" +
         html_text(text) + "</text>";
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return std::string("<line class=\"") + kind + "\" x1=\"" + length(x1) + "\" y1=\"" + length(y1) +
         "\" x2=\"" + length(x2) + "\" y2=\"" + length(y2) + "\"/>";
}

/// A label of an axis at a share of its length.
struct Tick {
  double share;
  std::string label;
};

constexpr double tick_length = 4, tick_text_below = 16, title_below = 32, tick_text_left = 7,
                 text_middle = 3.5;

std::string x_axis(const Plot& plot, const std::vector<Tick>& ticks, const std::string& title) {
  const double base = plot.y(0);
  std::string out = line(plot.x(0), base, plot.x(1), base, "axis");
  for (const Tick& t : ticks)
    out += line(plot.x(t.share), base, plot.x(t.share), base + tick_length, "axis") +
           text_at(plot.x(t.share), base + tick_text_below, "middle", t.label);
  return out + text_at(plot.x(0.5), base + title_below, "middle", title);
}

std::string y_axis(const Plot& plot, const std::vector<Tick>& ticks, const std::string& title) {
  std::string out;
  for (const Tick& t : ticks)
    out += line(plot.x(0), plot.y(t.share), plot.x(1), plot.y(t.share), "grid") +
           text_at(plot.x(0) - tick_text_left, plot.y(t.share) + text_middle, "end", t.label);
  constexpr double title_left = 10;
  const std::string at = length(title_left) + " " + length(plot.y(0.5));
  return out + "<text text-anchor=\"middle\" transform=\"translate(" + at + ") rotate(-90)\">" +
         html_text(title) + "</text>";
}

// Solid angles.

constexpr double solid_range = QualityHistogram::angle_bins * QualityHistogram::angle_step;
constexpr const char* solid_title = "smallest solid angle, sr";

std::vector<Tick> solid_ticks() {
  std::vector<Tick> ticks;
  for (int tenths = 0; tenths <= 5; ++tenths)
    ticks.push_back({tenths / 10.0 / solid_range, fixed_number(tenths / 10.0, 1)});
  return ticks;
}

// The chart of two dimensions.

/// Shades, each for twice the share of the one before; the last one is for `darkest_share` and more.
constexpr int shades = 9;
constexpr double darkest_share = 0.04;

/// 1 to `shades`, for a share above 0.
int shade_of(double share) {
  int shade = shades;
  for (double from = darkest_share; shade > 1 && share < from; from /= 2) --shade;
  return shade;
}

std::string quality_chart(const ChartMesh& mesh) {
  constexpr double bin_width = 16, bin_height = 6;
  constexpr std::size_t columns = QualityHistogram::angle_bins, rows = QualityHistogram::volume_bins;
  const Plot plot{bin_width * columns, bin_height * rows};
  std::array<std::string, shades> paths;
  for (std::size_t a = 0; a < columns; ++a)
    for (std::size_t v = 0; v < rows; ++v) {
      const std::size_t count = mesh.statistics->histogram.counts[a][v];
      if (count == 0) continue;
      const double share = static_cast<double>(count) / static_cast<double>(mesh.statistics->tets);
      const double x = plot.x(0) + bin_width * static_cast<double>(a),
                   y = plot.y(0) - bin_height * static_cast<double>(v + 1);
      paths[static_cast<std::size_t>(shade_of(share) - 1)] += "M" + length(x) + " " + length(y) + "h" +
                                                              length(bin_width) + "v" + length(bin_height) +
                                                              "h-" + length(bin_width) + "z";
    }
  std::string out =
      "<figure class=\"map\">" + plot.begin(mesh.name + ": tets by smallest solid angle and volume");
  const std::vector<Tick> volumes{{0, "1/256"}, {0.25, "1/16"}, {0.5, "1"}, {0.75, "16"}, {1, "256"}};
  out += y_axis(plot, volumes, "volume / mean volume") + x_axis(plot, solid_ticks(), solid_title);
  for (int s = 0; s < shades; ++s)
    if (const std::string& path = paths[static_cast<std::size_t>(s)]; !path.empty())
      out += "<path class=\"shade" + std::to_string(s + 1) + "\" d=\"" + path + "\"/>";
  return out + "</svg><figcaption>" + html_text(mesh.name) + ", " + grouped_number(mesh.statistics->tets) +
         " tets</figcaption></figure>";
}

std::string shade_legend() {
  std::string out = "<p class=\"legend\">Share of the tets in each bin: ";
  for (int s = 1; s <= shades; ++s) {
    const double percent = 100 * darkest_share / std::ldexp(1.0, shades - s);
    out += "<span class=\"swatch shade" + std::to_string(s) + "\"></span>";
    if (s % 2 == 0 || s == 1 || s == shades)
      out += (s == 1 ? std::string("below ") + fixed_number(2 * percent, 2) : fixed_number(percent, 2)) +
             (s == shades ? " % and more" : " % ");
  }
  return out + "</p>";
}

// Charts of one dimension.

/// Histogram of one mesh in a one-dimensional chart.
struct Bars {
  std::string name;
  std::vector<double> shares;  ///< of each bin, 0 to 1
};

template <class Counts>
std::vector<double> shares_of(const Counts& counts) {
  double all = 0;
  for (const std::size_t n : counts) all += static_cast<double>(n);
  std::vector<double> out;
  out.reserve(counts.size());
  for (const std::size_t n : counts) out.push_back(all > 0 ? static_cast<double>(n) / all : 0);
  return out;
}

/// The outline of the bars, from the left end of the axis to its right end.
std::string outline(const Plot& plot, const std::vector<double>& shares, double largest) {
  std::string out = "M" + length(plot.x(0)) + " " + length(plot.y(0));
  for (std::size_t i = 0; i < shares.size(); ++i)
    out += "V" + length(plot.y(shares[i] / largest)) + "H" +
           length(plot.x(static_cast<double>(i + 1) / static_cast<double>(shares.size())));
  return out + "V" + length(plot.y(0));
}

/// The end of an axis from 0 that holds the largest share: 1, 2 or 5 times a power of ten.
double axis_end(const std::vector<Bars>& all) {
  double largest = 0;
  for (const Bars& bars : all)
    for (const double share : bars.shares) largest = std::max(largest, share);
  constexpr double smallest_end = 0.001;
  for (double decade = smallest_end; decade < 1; decade *= 10)
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor * decade >= largest) return factor * decade;
  return 1;
}

std::string bar_chart(const std::vector<Bars>& all, const std::string& title, const std::vector<Tick>& ticks,
                      const std::string& share_of) {
  const Plot plot{420, 150};
  const double end = axis_end(all);
  const int decimals = end < 0.05 ? 1 : 0;
  std::vector<Tick> levels;
  for (const double share : {0.0, 0.5, 1.0})
    levels.push_back({share, fixed_number(100 * share * end, decimals)});
  std::string out = "<figure>" + plot.begin("Histogram: " + title);
  out += y_axis(plot, levels, "% of the " + share_of);
  for (std::size_t i = 0; i < all.size(); ++i)
    out += std::string("<path class=\"") + (i + 1 == all.size() ? "bars" : "outline") + "\" d=\"" +
           outline(plot, all[i].shares, end) + "\"/>";
  out += x_axis(plot, ticks, title) + "</svg><figcaption>";
  for (std::size_t i = all.size(); i-- > 0;)
    out += std::string("<span class=\"swatch ") + (i + 1 == all.size() ? "bars" : "outline") + "\"></span>" +
           html_text(all[i].name) + " ";
  return out + "</figcaption></figure>";
}

}  // namespace

std::string quality_charts(std::span<const ChartMesh> meshes) {
  std::string out = "<div class=\"charts\">";
  for (const ChartMesh& mesh : meshes) out += quality_chart(mesh);
  return out + "</div>" + shade_legend();
}

std::string solid_angle_chart(std::span<const ChartMesh> meshes) {
  std::vector<Bars> bars;
  for (const ChartMesh& mesh : meshes) {
    std::array<std::size_t, QualityHistogram::angle_bins> counts{};
    for (std::size_t a = 0; a < counts.size(); ++a)
      for (const std::size_t n : mesh.statistics->histogram.counts[a]) counts[a] += n;
    bars.push_back({mesh.name, shares_of(counts)});
  }
  return bar_chart(bars, solid_title, solid_ticks(), "tets");
}

std::string dihedral_chart(std::span<const ChartMesh> meshes) {
  std::vector<Bars> bars;
  for (const ChartMesh& mesh : meshes)
    bars.push_back({mesh.name, shares_of(mesh.statistics->dihedrals.counts)});
  constexpr int all_degrees = 180, tick_degrees = 30;
  std::vector<Tick> ticks;
  for (int degrees = 0; degrees <= all_degrees; degrees += tick_degrees)
    ticks.push_back({degrees / static_cast<double>(all_degrees), std::to_string(degrees)});
  return bar_chart(bars, "dihedral angle, degrees", ticks, "angles");
}

std::string iterations_chart(std::span<const IterationReport> iterations) {
  std::vector<const IterationReport*> shown;
  std::size_t most = 0;
  for (const IterationReport& it : iterations)
    if (it.kind == "simplify") {
      shown.push_back(&it);
      most = std::max(most, it.tets_before);
    }
  if (most == 0) return "";
  const Plot plot{420, 150};
  const auto count = static_cast<double>(shown.size());
  constexpr double bar_width = 0.8;  // of the distance between bars
  constexpr std::size_t bins = std::tuple_size_v<decltype(IterationReport::tets_by_quality)>;
  static_assert(bins < shades);
  std::array<std::string, bins> paths;
  std::string chosen;  // the lower end of the tets that an iteration works on
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double x = plot.x((static_cast<double>(i) + (1 - bar_width) / 2) / count),
                 width = bar_width * (plot.x(1) - plot.x(0)) / count;
    std::size_t top = shown[i]->tets_before;
    const auto y_of = [&](double tets) { return plot.y(tets / static_cast<double>(most)); };
    for (std::size_t b = 0; b < bins; ++b) {
      const std::size_t tets = shown[i]->tets_by_quality[b];
      const double from = y_of(static_cast<double>(top)), to = y_of(static_cast<double>(top - tets));
      top -= tets;
      if (length(to) == length(from)) continue;
      paths[b] += "M" + length(x) + " " + length(from) + "H" + length(x + width) + "V" + length(to) + "H" +
                  length(x) + "z";
    }
    const double not_chosen = 1 - std::min(100.0, shown[i]->percent) / 100;
    chosen += "M" + length(x) + " " + length(y_of(not_chosen * static_cast<double>(shown[i]->tets_before))) +
              "H" + length(x + width);
  }
  std::string out =
      "<div class=\"charts\"><figure>" + plot.begin("Tets before each iteration, the worst at the top");
  constexpr std::size_t max_label = 10'000;  // that the margin has room for
  const std::size_t unit = most < max_label ? 1 : 1000;
  out += y_axis(plot, {{0, "0"}, {0.5, grouped_number(most / 2 / unit)}, {1, grouped_number(most / unit)}},
                unit == 1 ? "tets" : "thousands of tets");
  const auto tick = [&](std::size_t i) {
    return Tick{(static_cast<double>(i) - 0.5) / count, std::to_string(i)};
  };
  std::vector<Tick> ticks{tick(1)};
  if (shown.size() > 2) ticks.push_back(tick((shown.size() + 1) / 2));
  if (shown.size() > 1) ticks.push_back(tick(shown.size()));
  // The worst tets have the darkest shade.
  const auto shade = [&](std::size_t b) { return "shade" + std::to_string(shades - static_cast<int>(b)); };
  for (std::size_t b = 0; b < bins; ++b)
    if (!paths[b].empty()) out += "<path class=\"" + shade(b) + "\" d=\"" + paths[b] + "\"/>";
  out += "<path class=\"outline\" d=\"" + chosen + "\"/>";
  out += x_axis(plot, ticks, "iteration") + "</svg><figcaption>Tets before each iteration, from the worst ";
  for (std::size_t b = 0; b < bins; ++b) out += "<span class=\"swatch " + shade(b) + "\"></span>";
  return out +
         " to the best; <span class=\"swatch outline\"></span> tets above this line are processed"
         "</figcaption></figure></div>";
}

}  // namespace tetwright
