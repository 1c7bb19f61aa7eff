// Signs by LU of the blocks; what changed is decided by following the constraints.
#include "run/branch_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "model_math/kinematics.hpp"
#include "run/scene_distance.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

constexpr int kLargestPart = 60;   // rows; larger ones would cost more than steps
constexpr double kUnknown = 1e-9;  // smallest pivot, of rows of length 1: no sign
constexpr double kStill = 1e-9;    // of the length a second: no direction of motion
constexpr double kSame = 1e-5;     // of the length: more than what constraints are violated by
constexpr int kMostUncertain = 8;  // looks
constexpr double kApart = 3e-3;    // of the length: less is not yet another assembly

/// The sign of the determinant of `size` rows by elimination with row pivots, which passes over
/// zeros, or 0 where a pivot is too small. (A determinant of many rows is small wherever it is.)
/// Overwrites them.
int sign_of(double* rows, std::size_t size) {
  int sign = 1;
  for (std::size_t k = 0; k < size; ++k) {
    double* row = rows + k * size;
    double* pivots = row;
    for (std::size_t i = k + 1; i < size; ++i) {
      double* const other = rows + i * size;
      if (std::abs(other[k]) > std::abs(pivots[k])) pivots = other;
    }
    const double pivot = pivots[k], most = std::abs(pivot);
    if (!(most > kUnknown && std::isfinite(most))) return 0;
    if (pivots != row) {
      std::swap_ranges(row + k, row + size, pivots + k);
      sign = -sign;
    }
    if (pivot < 0.0) sign = -sign;
    for (std::size_t i = k + 1; i < size; ++i) {
      double* const other = rows + i * size;
      if (other[k] == 0.0) continue;
      const double factor = other[k] / pivot;
      for (std::size_t j = k + 1; j < size; ++j) other[j] -= factor * row[j];
    }
  }
  return sign;
}

}  // namespace

BranchWatch::BranchWatch(const Scene& scene, const State& start, double length, bool wanted)
    : scene_(scene), length_(length) {
  if (!wanted) return;
  ClosedParts parts = closed_parts(scene.model, start.q, kLargestPart);
  freedoms_ = parts.freedoms;
  passes_on_ = std::move(parts.passes_on);
  has_redundant_rows_ = std::move(parts.has_redundant_rows);
  std::vector<ConstraintBlock> matrices;
  for (ClosedParts::Driven& part : parts.driven) {
    matrices.push_back(std::move(part.block));
    parts_.push_back({std::move(part.all), std::move(part.needed)});
  }
  for (ConstraintBlock& part : parts.free) {
    matrices.push_back(part);
    parts_.push_back({std::move(part), {}, is_driven(scene.model)});
  }
  if (!is_needed()) return;
  find_lengths();
  matrices_.emplace(scene.model, std::move(matrices));
  now_.resize(matrices_->size());
  turned_.resize(now_.size(), 1.0);
  tangent_ = start.v;
  find_tangents(start);
  find_signs(0.0, start);
  moor(0.0, start);
}

void BranchWatch::find_lengths() {
  std::vector<double> lengths;  // of coordinates
  const std::vector<double> its = lengths_of_points(scene_, length_);
  std::size_t place = 0;
  for (const Point& point : scene_.model.points()) {
    if (point.is_fixed()) continue;
    const auto end = static_cast<std::size_t>(point.offset + scene_.model.dimension());
    lengths.resize(std::max(lengths.size(), end));
    for (auto i = static_cast<std::size_t>(point.offset); i < end; ++i) lengths[i] = its[place];
    ++place;
  }
  for (Part& part : parts_) {
    part.length = length_;
    for (const int col : part.all.cols) {
      part.length = std::min(part.length, lengths[static_cast<std::size_t>(col)]);
    }
  }
  length_ = std::ranges::min(parts_, {}, &Part::length).length;
}

/// Of the parts that are carried.
void BranchWatch::find_tangents(const State& start) {
  matrices_->evaluate(0.0, start.q);
  for (std::size_t m = 0; m < matrices_->size(); ++m) {
    if (!is_carried(m)) continue;
    const auto& cols = matrices_->block(m).cols;
    const auto rows = static_cast<Eigen::Index>(matrices_->block(m).rows.size());
    const Eigen::VectorXd tangent =
        matrices_->matrix(m).topRows(rows).fullPivLu().kernel().col(0).normalized();
    for (std::size_t i = 0; i < cols.size(); ++i) {
      tangent_[static_cast<std::size_t>(cols[i])] = tangent[static_cast<Eigen::Index>(i)];
    }
  }
}

/// 1 where the motion goes on as `tangent`, -1 where it has turned back.
double BranchWatch::turned(const ConstraintBlock& block, const State& state) const {
  double product = 0.0;
  for (const int col : block.cols) {
    const auto i = static_cast<std::size_t>(col);
    product += state.v[i] * tangent_[i];
  }
  return product < 0.0 ? -1.0 : 1.0;
}

void BranchWatch::find_signs(double t, const State& state) {
  matrices_->evaluate(t, state.q);
  for (std::size_t m = 0; m < now_.size(); ++m) {
    const ConstraintBlock& block = matrices_->block(m);
    double* const square = matrices_->matrix(m).data();
    const std::size_t size = block.cols.size();
    double least = 0.0;                   // length of a row that has a direction
    if (BlockJacobian::is_open(block)) {  // one freedom: the direction of motion below
      const std::vector<double>& below = is_carried(m) ? tangent_ : state.v;
      if (!is_carried(m)) {
        turned_[m] = turned(block, state);
        least = kStill * parts_[m].length;
      }
      double* const last = square + (size - 1) * size;
      for (std::size_t j = 0; j < size; ++j) {
        last[j] = turned_[m] * below[static_cast<std::size_t>(block.cols[j])];
      }
    }
    eliminated_.resize(size * size);
    bool has_directions = true;
    for (std::size_t i = 0; i < size; ++i) {
      const double* const row = square + i * size;
      double squared = 0.0;
      for (std::size_t j = 0; j < size; ++j) squared += row[j] * row[j];
      const double length = std::sqrt(squared), scale = 1.0 / length;
      if (!(length > (i + 1 == size ? least : 0.0))) has_directions = false;
      for (std::size_t j = 0; j < size; ++j) eliminated_[i * size + j] = scale * row[j];
    }
    now_[m] = has_directions ? sign_of(eliminated_.data(), size) : 0;
  }
}

bool BranchWatch::is_across(double t, const State& state) {
  find_signs(t, state);
  for (std::size_t m = 0; m < now_.size(); ++m) {
    if (now_[m] * anchor_signs_[m] < 0) return true;
  }
  return false;
}

/// Of `state` the signs are known to be right.
void BranchWatch::moor(double t, const State& state) {
  for (std::size_t m = 0; m < now_.size(); ++m) {
    const ConstraintBlock& block = matrices_->block(m);
    if (!BlockJacobian::is_open(block)) continue;
    if (is_carried(m)) {
      if (now_[m] == 0) continue;
      const SquareMatrix& square = matrices_->matrix(m);  // with the row of find_signs()
      const Eigen::VectorXd tangent =
          square.partialPivLu()
              .solve(Eigen::VectorXd::Unit(square.rows(), square.rows() - 1))
              .normalized();
      for (std::size_t i = 0; i < block.cols.size(); ++i) {
        tangent_[static_cast<std::size_t>(block.cols[i])] = tangent[static_cast<Eigen::Index>(i)];
      }
      continue;
    }
    for (const int col : block.cols) {
      const auto i = static_cast<std::size_t>(col);
      tangent_[i] = turned_[m] * state.v[i];
    }
  }
  anchor_ = state;
  anchor_time_ = t;
  uncertain_ = 0;
  pending_.clear();
  anchor_signs_.resize(now_.size(), 0);
  for (std::size_t m = 0; m < now_.size(); ++m) {
    if (now_[m] != 0) anchor_signs_[m] = now_[m];
  }
}

std::string BranchWatch::place_of(std::size_t matrix) const {
  std::vector<std::string> names;
  constexpr std::size_t kShown = 4;
  for (const int row : matrices_->block(matrix).rows) {
    std::string name = row_name(scene_.model, row);
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  }
  if (names.size() > kShown) {
    names.resize(kShown);
    names.emplace_back("...");
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// From the anchor to `state`. A part that is carried is followed at one instant, to which the
/// other end is taken along: at both, for its curve may fall apart in between. None if neither can
/// be.
std::optional<FollowedCurve> BranchWatch::follow(const Part& part, double t,
                                                 const State& state) const {
  const Model& model = scene_.model;
  const CurveEnd from{anchor_time_, &anchor_.q, part.is_carried ? &tangent_ : &anchor_.v};
  const CurveEnd to{t, &state.q, part.is_carried ? &tangent_ : &state.v};
  const double length = part.length, tolerance = kApart * length;
  if (!part.is_carried)
    return follow_curve(model, part.all, part.blocks, from, to, length, tolerance);
  const auto back = carry_along(model, part.all, to, from, length);
  if (!back) return std::nullopt;
  const CurveEnd target{from.t, &*back, to.v};
  const FollowedCurve then = follow_curve(model, part.all, {}, from, target, length, tolerance);
  if (then.end == FollowedCurve::End::reached) return then;
  const auto onward = carry_along(model, part.all, from, to, length);
  if (!onward) return std::nullopt;
  const CurveEnd begin{to.t, &*onward, from.v};
  return follow_curve(model, part.all, {}, begin, to, length, tolerance);
}

std::string BranchWatch::look(double t, const State& state) {
  find_signs(t, state);
  bool is_certain = true;
  for (std::size_t m = 0; m < now_.size(); ++m) {
    // Nobody can tell on which branch it is: the anchor stays where that is known.
    if (now_[m] == 0 && anchor_signs_[m] != 0) is_certain = false;
    if (now_[m] * anchor_signs_[m] >= 0) continue;
    const Part& part = parts_[m];
    const std::optional<FollowedCurve> followed = follow(part, t, state);
    const auto lost = [&] {
      return fmt::format("at t = {:g} s {} cannot be followed by their constraints alone", t,
                         place_of(m));
    };
    if (!followed && uncertain_ < kMostUncertain) {
      is_certain = false;
      pending_ = lost();
      continue;
    }
    const FollowedCurve curve = followed.value_or(FollowedCurve{});
    switch (curve.end) {
      case FollowedCurve::End::reached:
        // Beside a singular position the other assembly is too close to tell.
        if (!curve.crossed && (!part.blocks.empty() || curve.distance > kSame * part.length)) {
          is_certain = false;
        }
        if (curve.crossed && passage_.empty() &&
            !has_redundant_rows_[static_cast<std::size_t>(part.all.cols.front())]) {
          passage_ =
              fmt::format("a singular position of {} was passed before t = {:g} s", place_of(m), t);
        }
        break;
      case FollowedCurve::End::lost:
        if (doubt_.empty()) doubt_ = lost();
        break;
      case FollowedCurve::End::elsewhere:
        if (std::isfinite(curve.least_time)) step_needed_ = curve.least_time;
        return place_of(m) + " jumped past a nearly singular position to another assembly" +
               (std::isfinite(curve.distance)
                    ? fmt::format(", {:.1e} m from where the constraints lead", curve.distance)
                    : "");
    }
  }
  if (is_certain) {
    moor(t, state);
  } else {
    ++uncertain_;
  }
  return "";
}

}  // namespace mbs
