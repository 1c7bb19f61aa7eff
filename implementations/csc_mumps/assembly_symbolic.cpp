// Set-up of an Assembly: points, patterns, write order and the schedule of products.
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "assembly.hpp"

namespace mbs::csc_mumps {

/// Fills the lists of an Assembly from a model; used once, at construction.
class Assembly::Builder {
 public:
  Builder(Assembly& assembly, const Model& model) : self_(assembly), model_(model) {}

  void build() {
    number_points();
    collect_rows();
    compress_jacobian();
    for (int i = 0; i < self_.linear_row_; ++i) lower_dot(i);
    // Distances are evaluated before general dot constraints, so they come first.
    self_.write_order_ = std::move(distance_writes_);
    self_.write_order_.insert(self_.write_order_.end(), dot_writes_.begin(), dot_writes_.end());
    lower_linear();
    build_mass();
    build_tangent();
  }

 private:
  /// One of the products that sum up to an entry of T, or just an entry (left = -1).
  struct Product {
    std::int64_t entry;  // column * n + row
    int left, right;
    bool operator<(const Product& other) const {
      return entry != other.entry ? entry < other.entry : left < other.left;
    }
  };

  void number_points() {
    for (const Point& point : model_.points()) {
      auto& fixed = self_.fixed_coordinates_;
      offset_.push_back(point.is_fixed() ? self_.variables_ + static_cast<int>(fixed.size())
                                         : point.offset);
      if (!point.is_fixed()) continue;
      fixed.insert(fixed.end(), point.position.begin(), point.position.begin() + self_.dimension_);
    }
  }

  [[nodiscard]] bool is_free(int offset) const { return offset < self_.variables_; }

  /// columns_of_[i]: columns of the structural non-zeros in row i of Phi_q, ascending.
  void collect_rows() {
    for (const DotConstraint& dot : model_.dot_constraints()) {
      std::vector<int>& columns = columns_of_.emplace_back();
      for (int point : {dot.a, dot.b, dot.c, dot.d}) {
        for (int axis = 0; axis < self_.dimension_ && is_free(offset_[point]); ++axis) {
          columns.push_back(offset_[point] + axis);
        }
      }
    }
    for (const LinearConstraint& linear : model_.linear_constraints()) {
      std::vector<int>& columns = columns_of_.emplace_back();
      for (const LinearConstraint::Term& term : linear.terms) columns.push_back(term.coordinate);
    }
    for (std::vector<int>& columns : columns_of_) {
      std::sort(columns.begin(), columns.end());
      columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    }
  }

  void compress_jacobian() {
    std::vector<int>& start = self_.column_start_;
    start.assign(self_.variables_ + 1, 0);
    for (const auto& columns : columns_of_) {
      for (int column : columns) ++start[column + 1];
    }
    for (int j = 0; j < self_.variables_; ++j) start[j + 1] += start[j];
    self_.row_.resize(start.back());
    self_.jacobian_.resize(start.back() + 1);
    std::vector<int> next(start.begin(), start.end() - 1);
    for (int row = 0; row < static_cast<int>(columns_of_.size()); ++row) {
      for (int column : columns_of_[row]) self_.row_[next[column]++] = row;
    }
  }

  /// Where Phi_q(row, column) is in jacobian_; the entry behind the last one for fixed points.
  [[nodiscard]] int place(int row, int column) const {
    if (!is_free(column)) return static_cast<int>(self_.row_.size());
    const auto first = self_.row_.begin();
    const auto end = first + self_.column_start_[column + 1];
    return static_cast<int>(std::lower_bound(first + self_.column_start_[column], end, row) -
                            first);
  }

  void lower_dot(int row) {
    const DotConstraint& dot = model_.dot_constraints()[row];
    const std::array<int, kPointsOfDot> at = {offset_[dot.a], offset_[dot.b], offset_[dot.c],
                                              offset_[dot.d]};
    if (at[0] == at[2] && at[1] == at[3] && at[0] != at[1]) {
      self_.distances_.push_back({at[0], at[1], row, dot.value});
      for (int axis = 0; axis < self_.dimension_; ++axis) {
        distance_writes_.push_back(place(row, at[0] + axis));
        distance_writes_.push_back(place(row, at[1] + axis));
      }
      return;
    }
    self_.dots_.push_back({at[0], at[1], at[2], at[3], row, dot.value});
    // Point p appears first at slot s: it takes every share of p; later slots of p write nowhere.
    const auto is_first = [&](int s) {
      return std::find(at.begin(), at.end(), at[s]) - at.begin() == s;
    };
    for (int s = 0; s < kPointsOfDot; ++s) {
      const auto at_s = [&](int slot) { return at[slot] == at[s] ? 1.0 : 0.0; };
      self_.gradients_.push_back({at_s(0) - at_s(1), at_s(2) - at_s(3)});
    }
    for (int axis = 0; axis < self_.dimension_; ++axis) {
      for (int s = 0; s < kPointsOfDot; ++s) {
        dot_writes_.push_back(place(row, is_first(s) ? at[s] + axis : self_.variables_));
      }
    }
  }

  void lower_linear() {
    int row = self_.linear_row_;
    self_.linear_start_.push_back(0);
    for (const LinearConstraint& linear : model_.linear_constraints()) {
      for (const LinearConstraint::Term& term : linear.terms) {
        self_.linear_terms_.push_back(term);
        self_.jacobian_[place(row, term.coordinate)] = term.coefficient;  // Eq. (8), constant
      }
      self_.linear_start_.push_back(static_cast<int>(self_.linear_terms_.size()));
      self_.linear_value_.push_back(linear.value);
      ++row;
    }
  }

  void build_mass() {
    self_.mass_pattern_.start.assign(self_.variables_ + 1, 0);
    for (const MassEntry& entry : model_.mass()) {
      ++self_.mass_pattern_.start[entry.col + 1];
      self_.mass_pattern_.row.push_back(entry.row);
      self_.mass_.push_back(entry.value);
    }
    for (int j = 0; j < self_.variables_; ++j) {
      self_.mass_pattern_.start[j + 1] += self_.mass_pattern_.start[j];
    }
  }

  /// Pattern of T as the union of those of M and Phi_q' Phi_q, and the schedule of products.
  void build_tangent() {
    std::vector<Product> products;
    const auto key = [&](int row, int column) {
      return std::int64_t{column} * self_.variables_ + row;
    };
    for (const MassEntry& entry : model_.mass()) {
      products.push_back({key(entry.row, entry.col), -1, -1});
    }
    for (int row = 0; row < static_cast<int>(columns_of_.size()); ++row) {
      const std::vector<int>& columns = columns_of_[row];
      const bool varies = row < self_.linear_row_;
      for (std::size_t i = 0; i < columns.size(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
          products.push_back({key(columns[i], columns[j]), varies ? place(row, columns[i]) : -1,
                              varies ? place(row, columns[j]) : -1});
        }
      }
    }
    std::sort(products.begin(), products.end());
    schedule(products);
    fill_constant();
  }

  void schedule(const std::vector<Product>& products) {
    LowerPattern& pattern = self_.pattern_;
    pattern.start.assign(self_.variables_ + 1, 0);
    std::int64_t previous = -1;
    for (const Product& product : products) {
      if (product.entry != previous) {
        ++pattern.start[product.entry / self_.variables_ + 1];
        pattern.row.push_back(static_cast<int>(product.entry % self_.variables_));
        previous = product.entry;
      }
      if (product.left < 0) continue;
      const int target = static_cast<int>(pattern.row.size()) - 1;
      if (self_.target_.empty() || self_.target_.back() != target) {
        self_.target_.push_back(target);
        self_.product_start_.push_back(static_cast<int>(self_.left_.size()));
      }
      self_.left_.push_back(product.left);
      self_.right_.push_back(product.right);
    }
    self_.product_start_.push_back(static_cast<int>(self_.left_.size()));
    for (int j = 0; j < self_.variables_; ++j) pattern.start[j + 1] += pattern.start[j];
  }

  /// M and the products of the linear constraints on the union pattern.
  void fill_constant() {
    for (auto* values : {&self_.constant_, &self_.update_, &self_.tangent_}) {
      values->assign(self_.pattern_.row.size(), 0.0);
    }
    const auto entry = [&](int row, int column) -> double& {
      const auto first = self_.pattern_.row.begin();
      const auto end = first + self_.pattern_.start[column + 1];
      return self_
          .constant_[std::lower_bound(first + self_.pattern_.start[column], end, row) - first];
    };
    for (const MassEntry& mass : model_.mass()) entry(mass.row, mass.col) += mass.value;
    for (const LinearConstraint& linear : model_.linear_constraints()) {
      for (const auto& [i, c_i] : linear.terms) {
        for (const auto& [j, c_j] : linear.terms) {
          if (i >= j) entry(i, j) += self_.quarter_ * self_.penalty_ * c_i * c_j;
        }
      }
    }
  }

  Assembly& self_;
  const Model& model_;
  std::vector<int> offset_;
  std::vector<std::vector<int>> columns_of_;
  std::vector<int> distance_writes_, dot_writes_;
};

Assembly::Assembly(const Model& model, double quarter, double penalty)
    : variables_(model.variables()),
      dimension_(model.dimension()),
      quarter_(quarter),
      penalty_(penalty),
      force_(model.force()),
      linear_row_(static_cast<int>(model.dot_constraints().size())),
      phi_(model.constraints()),
      weights_(model.constraints()) {
  Builder(*this, model).build();
}

}  // namespace mbs::csc_mumps
