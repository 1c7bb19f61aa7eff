// Signs by LU of the blocks; what changed is decided by following the constraints.
#include "run/branch_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "model_math/follow_curve.hpp"
#include "model_math/kinematics.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

constexpr int kLargestPart = 60;   // rows; larger ones would cost more than steps
constexpr double kUnknown = 1e-9;  // |determinant| over its rows' lengths: no sign
constexpr double kApart = 3e-3;    // of the length: less is not yet another assembly

}  // namespace

BranchWatch::BranchWatch(const Scene& scene, const State& start, double length, bool wanted)
    : scene_(scene), length_(length) {
  if (!wanted) return;
  const Model& model = scene.model;
  ClosedParts parts = closed_parts(model, start.q, kLargestPart);
  has_redundant_rows_ = parts.has_redundant_rows;
  if (!parts.driven.rows.empty()) add_part(std::move(parts.driven), std::move(parts.blocks));
  for (ConstraintBlock& part : parts.free) add_part(std::move(part), {});
  if (!is_needed()) return;
  const auto entries = jacobian(model, 0.0, start.q);
  for (std::size_t m = 0; m < matrices_.size(); ++m) {
    const ConstraintBlock& block = matrices_[m];
    const auto size = static_cast<int>(block.cols.size());
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const auto row = std::ranges::lower_bound(block.rows, entries[k].row);
      const auto col = std::ranges::lower_bound(block.cols, entries[k].col);
      if (row == block.rows.end() || *row != entries[k].row) continue;
      if (col == block.cols.end() || *col != entries[k].col) continue;
      slots_.push_back({static_cast<int>(m),
                        static_cast<int>(row - block.rows.begin()) +
                            size * static_cast<int>(col - block.cols.begin()),
                        k});
    }
  }
  tangent_ = start.v;
  moor(0.0, start, signs(0.0, start));
}

void BranchWatch::add_part(ConstraintBlock all, std::vector<ConstraintBlock> blocks) {
  for (const ConstraintBlock& block : blocks) {
    matrices_.push_back(block);
    part_of_.push_back(parts_.size());
  }
  if (blocks.empty()) {
    matrices_.push_back(all);
    part_of_.push_back(parts_.size());
  }
  parts_.push_back({std::move(all), std::move(blocks)});
}

std::vector<int> BranchWatch::signs(double t, const State& state) const {
  const auto entries = jacobian(scene_.model, t, state.q);
  std::vector<int> result(matrices_.size(), 0);
  auto slot = slots_.begin();
  for (std::size_t m = 0; m < matrices_.size(); ++m) {
    const ConstraintBlock& block = matrices_[m];
    const auto size = static_cast<Eigen::Index>(block.cols.size());
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(size, size);
    for (; slot != slots_.end() && slot->matrix == static_cast<int>(m); ++slot) {
      square.data()[slot->place] = entries[slot->entry].value;
    }
    if (block.rows.size() < block.cols.size()) {  // one freedom: the direction of motion below
      double turned = 0.0;
      for (Eigen::Index j = 0; j < size; ++j) {
        const auto col = static_cast<std::size_t>(block.cols[static_cast<std::size_t>(j)]);
        square(size - 1, j) = state.v[col];
        turned += state.v[col] * tangent_[col];
      }
      if (turned < 0.0) square.row(size - 1) *= -1.0;
    }
    double scale = 1.0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const double norm = square.row(i).norm();
      if (!(norm > 0.0))
        scale = 0.0;
      else
        square.row(i) /= norm;
    }
    if (scale == 0.0) continue;
    const double determinant = size == 1 ? square(0, 0)
                               : size == 2
                                   ? square(0, 0) * square(1, 1) - square(0, 1) * square(1, 0)
                                   : square.determinant();
    if (std::abs(determinant) > kUnknown) result[m] = determinant > 0.0 ? 1 : -1;
  }
  return result;
}

bool BranchWatch::is_across(double t, const State& state) const {
  const auto now = signs(t, state);
  for (std::size_t m = 0; m < now.size(); ++m) {
    if (now[m] * anchor_signs_[m] < 0) return true;
  }
  return false;
}

void BranchWatch::moor(double t, const State& state, std::vector<int> now) {
  for (std::size_t m = 0; m < now.size(); ++m) {
    if (now[m] == 0 && !anchor_signs_.empty()) now[m] = anchor_signs_[m];
  }
  for (const ConstraintBlock& block : matrices_) {
    if (block.rows.size() == block.cols.size()) continue;
    double turned = 0.0;
    for (const int col : block.cols) {
      turned += state.v[static_cast<std::size_t>(col)] * tangent_[static_cast<std::size_t>(col)];
    }
    for (const int col : block.cols) {
      const auto i = static_cast<std::size_t>(col);
      tangent_[i] = turned < 0.0 ? -state.v[i] : state.v[i];
    }
  }
  anchor_ = state;
  anchor_time_ = t;
  anchor_signs_ = std::move(now);
}

std::string BranchWatch::place_of(std::size_t matrix) const {
  std::vector<std::string> names;
  constexpr std::size_t kShown = 4;
  for (const int row : matrices_[matrix].rows) {
    std::string name = row_name(scene_.model, row);
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  }
  if (names.size() > kShown) {
    names.resize(kShown);
    names.emplace_back("...");
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string BranchWatch::look(double t, const State& state) {
  std::vector<int> now = signs(t, state);
  bool is_certain = true;
  for (std::size_t m = 0; m < now.size(); ++m) {
    if (now[m] * anchor_signs_[m] >= 0) continue;
    const Part& part = parts_[part_of_[m]];
    const FollowedCurve curve =
        follow_curve(scene_.model, part.all, part.blocks, {anchor_time_, &anchor_.q, &anchor_.v},
                     {t, &state.q, &state.v}, length_, kApart * length_);
    switch (curve.end) {
      case FollowedCurve::End::reached:
        if (!curve.crossed && !part.blocks.empty()) is_certain = false;  // too close to tell
        if (curve.crossed && passage_.empty() && !has_redundant_rows_) {
          passage_ =
              fmt::format("a singular position of {} was passed before t = {:g} s", place_of(m), t);
        }
        break;
      case FollowedCurve::End::lost:
        if (doubt_.empty()) {
          doubt_ = fmt::format("at t = {:g} s {} cannot be followed by their constraints alone", t,
                               place_of(m));
        }
        break;
      case FollowedCurve::End::elsewhere:
        if (std::isfinite(curve.least_time)) step_needed_ = curve.least_time;
        return fmt::format(
            "{} jumped past a nearly singular position to another assembly, {:.1e} m from where "
            "the constraints lead",
            place_of(m), curve.distance);
    }
  }
  if (is_certain) moor(t, state, std::move(now));
  return "";
}

}  // namespace mbs
