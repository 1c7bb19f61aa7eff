// The reference's matrix: which unknowns it couples, and an order of them with little work.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "describe/elimination.hpp"
#include "reference/reference_simulation.hpp"

namespace mbs {

namespace {

/// Multiplications of a factorization in this envelope.
double work(const std::vector<int>& first) {
  double sum = 0.0;
  for (int i = 0; i < static_cast<int>(first.size()); ++i) {
    for (int j = first[i]; j <= i; ++j) sum += j - std::max(first[i], first[j]) + 1;
  }
  return sum;
}

/// Breadth first from a far end, neighbours by their degree, the whole reversed (reverse
/// Cuthill-McKee).
std::vector<int> levels(const SymmetricPattern& pattern) {
  const auto degree = [&](int i) { return pattern.start[i + 1] - pattern.start[i]; };
  std::vector<int> order, seen(pattern.size(), 0);
  const auto walk = [&](int from, int mark) {  // appends what is connected with `from`
    std::size_t next = order.size();
    order.push_back(from);
    seen[from] = mark;
    for (; next < order.size(); ++next) {
      const std::size_t known = order.size();
      for (int k = pattern.start[order[next]]; k < pattern.start[order[next] + 1]; ++k) {
        const int other = pattern.rows[k];
        if (seen[other] != mark) order.push_back(other);
        seen[other] = mark;
      }
      std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(known), order.end(),
                       [&](int a, int b) { return degree(a) < degree(b); });
    }
  };
  for (int i = 0; i < pattern.size(); ++i) {
    if (seen[i] != 0) continue;
    const std::size_t before = order.size();
    for (int from = i, mark = 1; mark <= 3; ++mark) {  // each begins at the end of the last
      order.resize(before);
      walk(from, mark);
      from = order.back();
    }
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

void ReferenceSimulation::set_up_matrix() {
  // Which coordinates each constraint and element couples. A multiplier's pivot is safe when one of
  // its `firm` groups is eliminated: gradients of those are never small.
  std::vector<std::vector<int>> constraints, elements;
  std::vector<std::vector<std::vector<int>>> firm, whole;
  const auto coordinates = [&](std::initializer_list<int> points) {
    std::vector<int> result;
    for (const int point : points) {
      for (int k = 0; offset(point) >= 0 && k < model_.dimension(); ++k) {
        result.push_back(offset(point) + k);
      }
    }
    return result;
  };
  for (const DotConstraint& c : model_.dot_constraints()) {
    constraints.push_back(coordinates({c.a, c.b, c.c, c.d}));
    firm.push_back({constraints.back()});
    if (c.is_distance()) firm.back() = {coordinates({c.a}), coordinates({c.b})};
  }
  for (const BilinearConstraint& c : model_.bilinear_constraints()) {
    constraints.push_back(coordinates({c.a, c.b, c.c, c.d}));
    firm.push_back({constraints.back()});
  }
  for (const LinearConstraint& c : model_.linear_constraints()) {
    constraints.emplace_back();
    firm.emplace_back();
    double largest = 0.0;
    for (const auto& term : c.terms) largest = std::max(largest, std::abs(term.coefficient));
    for (const auto& term : c.terms) {
      constraints.back().push_back(term.coordinate);
      if (std::abs(term.coefficient) >= largest / 2) firm.back().push_back({term.coordinate});
    }
  }
  for (const Spring& s : model_.springs()) elements.push_back(coordinates({s.a, s.b}));
  for (const TorsionSpring& s : model_.torsion_springs()) {
    elements.push_back(coordinates({s.a, s.b, s.c, s.d}));
  }
  for (const ForceLaw& l : model_.force_laws()) elements.push_back(coordinates({l.a, l.b}));
  for (const TorqueLaw& l : model_.torque_laws()) {
    elements.push_back(coordinates({l.a, l.b, l.c, l.d}));
  }

  // The rows' first columns, with the unknowns in the places of `place_`.
  const auto envelope = [&] {
    std::vector<int> first(place_.size());
    std::iota(first.begin(), first.end(), 0);
    const auto couple = [&](const std::vector<int>& unknowns) {
      int lowest = std::numeric_limits<int>::max();
      for (const int i : unknowns) lowest = std::min(lowest, place_[i]);
      for (const int i : unknowns) first[place_[i]] = std::min(first[place_[i]], lowest);
    };
    for (const MassEntry& entry : model_.mass()) {
      if (entry.value != 0.0) couple({entry.row, entry.col});
    }
    for (const auto& element : elements) couple(element);
    for (int k = 0; k < m_; ++k) {
      if (!is_saddle()) {
        couple(constraints[k]);
        continue;
      }
      for (const int i : constraints[k]) couple({i, n_ + k});
      if (settings_.geometric_stiffness) couple(constraints[k]);
    }
    return first;
  };
  std::vector<int> natural(n_), first, kept;
  std::iota(natural.begin(), natural.end(), 0);
  const SymmetricPattern pattern = tangent_pattern(model_);
  for (const auto& all : constraints) whole.push_back({all});
  double least = std::numeric_limits<double>::infinity();
  for (const auto& order : {natural, amd_order(pattern), levels(pattern)}) {
    // Where many legs stand on one body, `firm` saves nearly all; else its pivots are not worth it.
    for (const auto& [groups, weight] : {std::pair{&whole, 1.0}, std::pair{&firm, 4.0}}) {
      place_ = places(order, *groups);
      std::vector<int> other = envelope();
      const double cost = weight * work(other);
      if (!first.empty() && cost >= least) continue;
      least = cost;
      first = std::move(other);
      kept = place_;
    }
  }
  place_ = std::move(kept);
  matrix_ = EnvelopeLdlt(std::move(first));
}

std::vector<int> ReferenceSimulation::places(
    const std::vector<int>& coordinates,
    const std::vector<std::vector<std::vector<int>>>& groups) const {
  std::vector<int> rank(n_), result(is_saddle() ? n_ + m_ : n_);
  for (int place = 0; place < n_; ++place) rank[coordinates[place]] = place;
  const auto last_of = [&](const std::vector<int>& group) {
    int last = -1;
    for (const int i : group) last = std::max(last, rank[i]);
    return last;
  };
  std::vector<std::pair<int, int>> order;  // rank of a coordinate, and 0 or 1 + the multiplier
  for (int i = 0; i < n_; ++i) order.emplace_back(i, 0);
  for (int k = 0; is_saddle() && k < m_; ++k) {
    int after = n_ - 1;
    for (const auto& group : groups[k]) {
      if (!group.empty()) after = std::min(after, last_of(group));
    }
    order.emplace_back(after, 1 + k);
  }
  std::sort(order.begin(), order.end());
  for (int place = 0; place < static_cast<int>(order.size()); ++place) {
    const auto [coordinate, multiplier] = order[place];
    result[multiplier == 0 ? coordinates[coordinate] : n_ + multiplier - 1] = place;
  }
  return result;
}

}  // namespace mbs
