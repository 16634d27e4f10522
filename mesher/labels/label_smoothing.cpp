// SPDX-License-Identifier: Apache-2.0
#include "mesher/labels/label_smoothing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

using Smoothing = LabelTuning::Smoothing;

/// Normalised binomial coefficients of order 4; their variance is 1.
constexpr std::array<float, 5> kernel{0.0625F, 0.25F, 0.375F, 0.25F, 0.0625F};
constexpr int kernel_reach = 2;
/// Standard deviation of the smoothing kernel, and the derivative of probit(u) with respect to t = 2u - 1 at
/// 0.
constexpr float deviation = 1.0F, probit_slope = 1.2533141F;

/// Approximates -probit(u) using only + - * / and sqrt, which round identically everywhere: within 0.05 up to
/// 1.6 voxels from a flat interface, 0.17 too large at the band.
float distance_from_share(float u) {
  const float t = std::clamp(2 * u - 1, -Smoothing::max_excess, Smoothing::max_excess);
  return -deviation * probit_slope * t / std::sqrt(std::sqrt(1 - t * t));
}

/// The depth, in voxels, of the centre of a voxel most of which its label still lacks.
float distance_from_lack(float lack) {
  constexpr float from = Smoothing::lack_from, to = Smoothing::lack_to;
  return Smoothing::deepest * std::clamp((lack - from) / (to - from), 0.0F, 1.0F);
}

}  // namespace

LabelSmoother::LabelSmoother()
    : raw_(volume), own_(volume), numbers_(1 << 16), rows_(volume), slices_(volume) {}

std::size_t LabelSmoother::number_labels() {
  labels_.clear();
  RegionIndex last = raw_[0];
  numbers_[last] = 1;
  labels_.push_back(last);
  for (RegionIndex r : raw_) {
    if (r == last) continue;
    last = r;
    if (numbers_[r]) continue;
    numbers_[r] = 1;
    labels_.push_back(r);
  }
  std::sort(labels_.begin(), labels_.end());
  for (std::size_t i = 0; i < labels_.size(); ++i) numbers_[labels_[i]] = static_cast<std::uint16_t>(i + 1);
  boxes_.assign(labels_.size(), {{side, side, side}, {0, 0, 0}});
  int i = 0;
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x, ++i) {
        own_[i] = static_cast<std::uint16_t>(numbers_[raw_[i]] - 1);
        Box& b = boxes_[own_[i]];
        const std::array<int, 3> at{x, y, z};
        for (int a = 0; a < 3; ++a) {
          b.low[a] = std::min(b.low[a], at[a]);
          b.high[a] = std::max(b.high[a], at[a] + 1);
        }
      }
  for (RegionIndex r : labels_) numbers_[r] = 0;
  if (labels_.size() > Smoothing::max_labels) return labels_.size();
  if (fields_.size() < labels_.size()) {
    fields_.resize(labels_.size());
    missing_.resize(labels_.size());
  }
  missing_boxes_.resize(labels_.size());
  return labels_.size();
}

void LabelSmoother::find_mixed_nodes() {
  mixed_.clear();
  near_.clear();
  mixed_at_.assign(volume, -1);
  std::vector<std::uint16_t> found;
  for (int z = 1; z + 1 < side; ++z)
    for (int y = 1; y + 1 < side; ++y)
      for (int x = 1; x + 1 < side; ++x) {
        const int here = place(x, y, z);
        const std::uint16_t own = own_[here];
        found.clear();
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy) {
            const std::uint16_t* row = &own_[here + place(-1, dy, dz)];
            for (int k = 0; k < 3; ++k)
              if (row[k] != own && std::find(found.begin(), found.end(), row[k]) == found.end())
                found.push_back(row[k]);
          }
        if (found.empty()) continue;
        mixed_at_[here] = static_cast<std::int32_t>(mixed_.size());
        found.push_back(own);
        std::sort(found.begin(), found.end());
        mixed_.push_back({here, own, static_cast<std::uint16_t>(found.size()),
                          static_cast<std::uint32_t>(near_.size()), 0});
        near_.insert(near_.end(), found.begin(), found.end());
      }
}

void LabelSmoother::add_smoothed(const Field& from, const Box& box, int margin, float factor, Field& to) {
  Box out;
  for (int a = 0; a < 3; ++a) {
    out.low[a] = std::max(margin, box.low[a] - kernel_reach);
    out.high[a] = std::min(side - margin, box.high[a] + kernel_reach);
    if (out.low[a] >= out.high[a]) return;
  }
  const int width = out.high[0] - out.low[0];
  // Along x, on a copy of the row padded with zeros.
  std::array<float, side + 4 * kernel_reach> padded{};
  for (int z = box.low[2]; z < box.high[2]; ++z)
    for (int y = box.low[1]; y < box.high[1]; ++y) {
      padded.fill(0);
      std::copy(&from[place(box.low[0], y, z)], &from[place(box.high[0] - 1, y, z)] + 1,
                &padded[box.low[0] + kernel_reach]);
      float* row = &rows_[place(out.low[0], y, z)];
      const float* in = &padded[out.low[0]];
      for (int x = 0; x < width; ++x)
        row[x] =
            kernel[0] * (in[x] + in[x + 4]) + kernel[1] * (in[x + 1] + in[x + 3]) + kernel[2] * in[x + 2];
    }
  for (int z = box.low[2]; z < box.high[2]; ++z)
    for (int y = out.low[1]; y < out.high[1]; ++y) {
      float* row = &slices_[place(out.low[0], y, z)];
      std::fill(row, row + width, 0.0F);
      for (int d = -kernel_reach; d <= kernel_reach; ++d) {
        if (y + d < box.low[1] || y + d >= box.high[1]) continue;
        const float* in = &rows_[place(out.low[0], y + d, z)];
        const float k = kernel[d + kernel_reach];
        for (int x = 0; x < width; ++x) row[x] += k * in[x];
      }
    }
  for (int z = out.low[2]; z < out.high[2]; ++z)
    for (int y = out.low[1]; y < out.high[1]; ++y) {
      float* row = &to[place(out.low[0], y, z)];
      for (int d = -kernel_reach; d <= kernel_reach; ++d) {
        if (z + d < box.low[2] || z + d >= box.high[2]) continue;
        const float* in = &slices_[place(out.low[0], y, z + d)];
        const float k = factor * kernel[d + kernel_reach];
        for (int x = 0; x < width; ++x) row[x] += k * in[x];
      }
    }
}

void LabelSmoother::clear(Field& field, const Box& box) {
  for (int z = box.low[2]; z < box.high[2]; ++z)
    for (int y = box.low[1]; y < box.high[1]; ++y)
      std::fill(&field[place(box.low[0], y, z)], &field[place(box.high[0] - 1, y, z)] + 1, 0.0F);
}

void LabelSmoother::add_missing_shares(int margin) {
  for (std::size_t l = 0; l < labels_.size(); ++l) {
    missing_[l].resize(volume);
    missing_boxes_[l] = {{side, side, side}, {0, 0, 0}};
  }
  // For each label near a node, the values at the eight sample points a quarter of a voxel from the centre
  // along each axis.
  std::vector<std::array<float, 8>> samples;
  std::vector<float> got;
  for (MixedNode& n : mixed_) {
    const std::array<int, 3> at = position(n.place);
    if (*std::min_element(at.begin(), at.end()) < margin ||
        *std::max_element(at.begin(), at.end()) >= side - margin)
      continue;
    const auto near = labels_near(n);
    samples.resize(near.size());
    for (std::size_t l = 0; l < near.size(); ++l) {
      const float* f = &fields_[near[l]][n.place];
      const auto mix = [](float away, float here, float other_way, float& low, float& high) {
        low = 0.75F * here + 0.25F * away;
        high = 0.75F * here + 0.25F * other_way;
      };
      float along_x[9][2], along_y[3][2][2];
      for (int k = 0; k < 9; ++k) {
        const float* row = f + place(0, k % 3 - 1, k / 3 - 1);
        mix(row[-1], row[0], row[1], along_x[k][0], along_x[k][1]);
      }
      for (int z = 0; z < 3; ++z)
        for (int x = 0; x < 2; ++x)
          mix(along_x[3 * z][x], along_x[3 * z + 1][x], along_x[3 * z + 2][x], along_y[z][0][x],
              along_y[z][1][x]);
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
          mix(along_y[0][y][x], along_y[1][y][x], along_y[2][y][x], samples[l][2 * y + x],
              samples[l][4 + 2 * y + x]);
    }
    got.assign(near.size(), 0);
    for (int s = 0; s < 8; ++s) {
      float first = -HUGE_VALF, second = -HUGE_VALF;
      std::size_t winner = 0;
      for (std::size_t l = 0; l < near.size(); ++l)
        if (samples[l][s] > first)
          second = first, first = samples[l][s], winner = l;
        else
          second = std::max(second, samples[l][s]);
      float sum = 0;
      std::array<float, 27> share;
      for (std::size_t l = 0; l < near.size(); ++l) {
        const float lead = samples[l][s] - (l == winner ? second : first);
        share[l] = std::clamp(0.5F + lead / Smoothing::sure_lead, 0.0F, 1.0F);
        sum += share[l];
      }
      for (std::size_t l = 0; l < near.size(); ++l) got[l] += share[l] / (8 * sum);
    }
    for (std::size_t l = 0; l < near.size(); ++l) {
      const float lack = (near[l] == n.own ? 1.0F : 0.0F) - got[l];
      if (near[l] == n.own) n.lack = lack;
      if (lack == 0) continue;
      missing_[near[l]][n.place] = lack;
      Box& b = missing_boxes_[near[l]];
      for (int a = 0; a < 3; ++a) {
        b.low[a] = std::min(b.low[a], at[a]);
        b.high[a] = std::max(b.high[a], at[a] + 1);
      }
    }
  }
  for (std::size_t l = 0; l < labels_.size(); ++l)
    if (missing_boxes_[l].low[0] < side) {
      add_smoothed(missing_[l], missing_boxes_[l], margin + kernel_reach, Smoothing::given_back, fields_[l]);
      clear(missing_[l], missing_boxes_[l]);
    }
}

void LabelSmoother::enforce_own_labels() {
  for (const MixedNode& n : mixed_) {
    float others = -HUGE_VALF;
    for (std::uint16_t l : labels_near(n))
      if (l != n.own) others = std::max(others, fields_[l][n.place]);
    float& own = fields_[n.own][n.place];
    own = std::max(own, others + Smoothing::min_lead);
  }
}

void LabelSmoother::distances_from_shares(int margin, std::span<const float> growth) {
  // Shares vanish beyond one node from a label (where part of a voxel may be missing) plus the reach of the
  // kernel.
  constexpr int reach_of_shares = 1 + kernel_reach;
  const float none = std::clamp(distance_from_share(0), -band, band);
  for (std::size_t l = 0; l < labels_.size(); ++l) {
    std::array<int, 3> low, high;
    for (int a = 0; a < 3; ++a) {
      low[a] = std::clamp(boxes_[l].low[a] - reach_of_shares, margin, side - margin);
      high[a] = std::clamp(boxes_[l].high[a] + reach_of_shares, low[a], side - margin);
    }
    for (int z = margin; z < side - margin; ++z)
      for (int y = margin; y < side - margin; ++y) {
        float* row = &fields_[l][place(0, y, z)];
        if (z < low[2] || z >= high[2] || y < low[1] || y >= high[1]) {
          std::fill(row + margin, row + side - margin, none);
          continue;
        }
        std::fill(row + margin, row + low[0], none);
        for (int x = low[0]; x < high[0]; ++x) row[x] = std::clamp(distance_from_share(row[x]), -band, band);
        std::fill(row + high[0], row + side - margin, none);
      }
  }
  // Enforce own labels again, because shares below 0 and above 1 were clamped. No distance leaves the band.
  for (const MixedNode& n : mixed_) {
    // If the label must shrink, its fixed depth is reduced.
    const float fixed_depth = distance_from_lack(n.lack) + std::min(0.0F, growth[labels_[n.own]]);
    const float lead = 2 * std::max(Smoothing::min_distance, fixed_depth);
    float others = HUGE_VALF;
    for (std::uint16_t l : labels_near(n)) {
      if (l == n.own) continue;
      float& other = fields_[l][n.place];
      other = std::max(other, lead - band);
      others = std::min(others, other);
    }
    float& own = fields_[n.own][n.place];
    own = std::min(own, others - lead);
  }
}

void LabelSmoother::enforce_contacts() {
  // Lifts are computed from the unmodified distances, so they do not depend on the order of nodes.
  std::vector<Lift> lifts;
  for (const MixedNode& n : mixed_) {
    for (int normal = 0; normal < 3; ++normal) {
      connect_edge(n, normal, lifts);
      widen_contact(n, normal, lifts);
    }
    connect_corner(n, lifts);
  }
  std::sort(lifts.begin(), lifts.end(), [](const Lift& x, const Lift& y) {
    return std::tuple(x.place, x.label, y.by) < std::tuple(y.place, y.label, x.by);
  });
  for (std::size_t i = 0; i < lifts.size(); ++i) {
    const Lift& lift = lifts[i];
    if (i > 0 && lift.place == lifts[i - 1].place && lift.label == lifts[i - 1].label) continue;
    float& d = fields_[lift.label][lift.place];
    d = std::max(d - lift.by, -band);
  }
}

void LabelSmoother::connect_edge(const MixedNode& n, int normal, std::vector<Lift>& lifts) const {
  const std::array<int, 3> at = position(n.place);
  const int a = (normal + 1) % 3, b = (normal + 2) % 3;
  if (!settled(at[normal]) || !settled(at[a]) || !settled(at[a] + 1) || !settled(at[b]) ||
      !settled(at[b] + 1))
    return;
  const std::array<int, 4> quad{n.place, n.place + steps[a], n.place + steps[b],
                                n.place + steps[a] + steps[b]};
  const std::uint16_t p = own_[quad[0]], p2 = own_[quad[3]], q = own_[quad[1]], q2 = own_[quad[2]];
  if (p == q || p == q2 || p2 == q || p2 == q2 || (p != p2 && q != q2)) return;
  bool connect_p = p == p2;
  if (p == p2 && q == q2) {
    int p_count = 0, q_count = 0;
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 2; ++j)
        for (int i = -1; i <= 2; ++i) {
          const std::uint16_t l = own_[n.place + i * steps[a] + j * steps[b] + k * steps[normal]];
          p_count += l == p;
          q_count += l == q;
        }
    connect_p = p_count < q_count || (p_count == q_count && p < q);
  }
  const std::uint16_t connected = connect_p ? p : q;
  float lack = 0;
  for (const std::uint16_t other : connect_p ? std::array{q, q2} : std::array{p, p2}) {
    float lead = 0;
    for (int v : quad) lead += fields_[connected][v] - fields_[other][v];
    lack = std::max(lack, lead + 4 * 2 * Smoothing::min_connection);
  }
  if (lack <= 0) return;
  for (int v : quad)
    if (own_[v] == connected) lifts.push_back({v, connected, lack / 2});
}

void LabelSmoother::connect_corner(const MixedNode& n, std::vector<Lift>& lifts) const {
  for (const int i : position(n.place))
    if (!settled(i) || !settled(i + 1)) return;
  constexpr int corners = 8;
  std::array<int, corners> block{};
  std::array<std::uint16_t, corners> own{};
  for (int c = 0; c < corners; ++c) {
    block[c] = n.place + place(c & 1, c >> 1 & 1, c >> 2);
    own[c] = own_[block[c]];
  }
  const auto voxels_of = [&](std::uint16_t label) { return std::count(own.begin(), own.end(), label); };
  bool apart = false;
  for (int c = 0; c < corners / 2; ++c)
    apart = apart || (own[c] == own[corners - 1 - c] && voxels_of(own[c]) == 2);
  if (!apart) return;
  std::optional<std::pair<int, std::uint16_t>> rarest;
  for (int c = 0; c < corners / 2; ++c) {
    if (own[c] != own[corners - 1 - c]) continue;
    int count = 0;
    for (int k = -1; k <= 2; ++k)
      for (int j = -1; j <= 2; ++j)
        for (int i = -1; i <= 2; ++i) count += own_[n.place + place(i, j, k)] == own[c];
    const std::pair candidate(count, own[c]);
    if (!rarest || candidate < *rarest) rarest = candidate;
  }
  const std::uint16_t connected = rarest->second;
  float lack = 0;
  for (const std::uint16_t other : own) {
    if (other == connected) continue;
    float lead = 0;
    for (const int v : block) lead += fields_[connected][v] - fields_[other][v];
    lack = std::max(lack, lead + corners * 2 * Smoothing::min_corner_connection);
  }
  // The two nodes alone cannot outweigh the six others, where the label comes closer to the node's own one.
  std::array<float, corners> by{};
  std::array<bool, corners> full{};
  for (int round = 0; round < corners && lack > 0; ++round) {
    const auto left = std::count(full.begin(), full.end(), false);
    if (left == 0) break;
    const float share = lack / static_cast<float>(left);
    for (int c = 0; c < corners; ++c) {
      if (full[c]) continue;
      const float at_node = fields_[connected][block[c]];
      const float most =
          own[c] == connected
              ? at_node + band
              : std::max(0.0F, at_node - fields_[own[c]][block[c]] - 2 * Smoothing::min_distance);
      const float before = by[c];
      full[c] = before + share >= most;
      by[c] = std::min(before + share, most);
      lack -= by[c] - before;
    }
  }
  for (int c = 0; c < corners; ++c)
    if (by[c] > 0) lifts.push_back({block[c], connected, by[c]});
}

void LabelSmoother::widen_contact(const MixedNode& n, int normal, std::vector<Lift>& lifts) const {
  const int p = n.place, q = p + steps[normal];
  const std::array<int, 3> at = position(p);
  for (int a = 0; a < 3; ++a)
    if (!settled(at[a]) || !settled(at[a] + (a == normal))) return;
  const std::uint16_t here = own_[p], there = own_[q];
  if (here == there) return;
  const float at_p = fields_[there][p] - fields_[here][p], at_q = fields_[here][q] - fields_[there][q];
  const float share = at_p / (at_p + at_q);  // both are positive: own labels were enforced
  const float both = fields_[here][p] + share * (fields_[here][q] - fields_[here][p]);
  float lack = 0;
  // Labels near only the other node are handled with its other faces.
  for (std::uint16_t l : labels_near(n)) {
    if (l == here || l == there) continue;
    const float third = fields_[l][p] + share * (fields_[l][q] - fields_[l][p]);
    lack = std::max(lack, both + 2 * Smoothing::min_contact - third);
  }
  if (lack <= 0) return;
  for (int v : {p, q}) lifts.push_back({v, own_[v], 2 * lack});
}

void LabelSmoother::grow(std::span<const float> growth) {
  for (const MixedNode& n : mixed_)
    for (std::uint16_t l : labels_near(n)) {
      float& u = fields_[l][n.place];
      // 1 at the label's interface, 0 far from it.
      const float near = std::clamp(4 * u * (1 - u), 0.0F, 1.0F);
      u += Smoothing::share_per_voxel * growth[labels_[l]] * near;
    }
}

void LabelSmoother::smooth(std::span<const float> growth) {
  find_mixed_nodes();
  for (std::size_t l = 0; l < labels_.size(); ++l) {
    Field& indicator = missing_[l];
    indicator.resize(volume);  // 0 everywhere
    for (int z = boxes_[l].low[2]; z < boxes_[l].high[2]; ++z)
      for (int y = boxes_[l].low[1]; y < boxes_[l].high[1]; ++y)
        for (int i = place(boxes_[l].low[0], y, z); i < place(boxes_[l].high[0], y, z); ++i)
          indicator[i] = own_[i] == l ? 1.0F : 0.0F;
    fields_[l].assign(volume, 0);
    add_smoothed(indicator, boxes_[l], kernel_reach, 1, fields_[l]);
    clear(indicator, boxes_[l]);
  }
  int margin = kernel_reach;
  for (int k = 0; k < Smoothing::back_projections; ++k) {
    add_missing_shares(margin + 1);
    margin += 1 + kernel_reach;
    enforce_own_labels();
  }
  grow(growth);
  enforce_own_labels();
  static_assert(kernel_reach + Smoothing::back_projections * (1 + kernel_reach) + 1 == reach);
  distances_from_shares(margin, growth);
  enforce_contacts();
}

}  // namespace tetwright
