// Storage and evaluation: M, Phi, Phi_q and the tangent matrix in compressed sparse columns.
#include "assembly.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace mbs::csc_klu {
namespace {

/// Both triangles of M.
std::vector<Pattern::Position> mass_positions(const Model& model) {
  std::vector<Pattern::Position> positions;
  for (const MassEntry& entry : model.mass()) {
    positions.push_back({entry.row, entry.col});
    positions.push_back({entry.col, entry.row});
  }
  return positions;
}

/// Adds M to `values` on `pattern`, which holds all positions of M.
void add_mass(const Model& model, const Pattern& pattern, std::vector<double>& values) {
  for (const MassEntry& entry : model.mass()) {
    values[pattern.offset(entry.row, entry.col)] += entry.value;
    if (entry.row != entry.col) values[pattern.offset(entry.col, entry.row)] += entry.value;
  }
}

}  // namespace

Pattern::Pattern(int columns, std::vector<Position> positions) : column_begin(columns + 1, 0) {
  std::ranges::sort(positions, {}, [](const Position& p) { return std::tuple(p.col, p.row); });
  const auto repeated = std::ranges::unique(positions);
  positions.erase(repeated.begin(), repeated.end());
  row.reserve(positions.size());
  for (const Position& position : positions) {
    row.push_back(position.row);
    ++column_begin[position.col + 1];
  }
  std::partial_sum(column_begin.begin(), column_begin.end(), column_begin.begin());
}

int Pattern::offset(int row_index, int col) const {
  const auto begin = row.begin() + column_begin[col], end = row.begin() + column_begin[col + 1];
  return static_cast<int>(std::lower_bound(begin, end, row_index) - row.begin());
}

MassMatrix::MassMatrix(const Model& model)
    : pattern_(model.variables(), mass_positions(model)), values_(pattern_.entries(), 0.0) {
  add_mass(model, pattern_, values_);
}

void MassMatrix::multiply(const double* x, double* y) const {
  const int* const row = pattern_.row.data();
  const double* const value = values_.data();
  int k = 0;
  for (int i = 0; i < pattern_.columns(); ++i) {
    double sum = 0.0;
    for (const int end = pattern_.column_begin[i + 1]; k < end; ++k) sum += value[k] * x[row[k]];
    y[i] = sum;
  }
}

void MassMatrix::multiply(const double* x1, const double* x2, double* y1, double* y2) const {
  const int* const row = pattern_.row.data();
  const double* const value = values_.data();
  int k = 0;
  for (int i = 0; i < pattern_.columns(); ++i) {
    double sum1 = 0.0, sum2 = 0.0;
    for (const int end = pattern_.column_begin[i + 1]; k < end; ++k) {
      sum1 += value[k] * x1[row[k]];
      sum2 += value[k] * x2[row[k]];
    }
    y1[i] = sum1;
    y2[i] = sum2;
  }
}

namespace {

bool is_distance(const DotConstraint& dot) {
  return dot.a == dot.c && dot.b == dot.d && dot.a != dot.b;
}

/// The model's constraints in the order of JacobianPattern.
std::vector<int> distances_first(const Model& model) {
  std::vector<int> order(model.constraints());
  std::iota(order.begin(), order.end(), 0);
  const std::span<const DotConstraint> dots = model.dot_constraints();
  std::stable_partition(order.begin(), order.begin() + std::ssize(dots),
                        [&](int i) { return is_distance(dots[i]); });
  return order;
}

/// Offsets of all points in the extended vector.
std::vector<int> extended_offsets(const Model& model) {
  std::vector<int> offsets;
  int fixed = model.variables();
  for (const Point& point : model.points()) {
    offsets.push_back(point.is_fixed() ? fixed : point.offset);
    if (point.is_fixed()) fixed += model.dimension();
  }
  return offsets;
}

/// A block of Phi_q: its constraint, its free point, the signs of JacobianPattern::Term and,
/// once all blocks are known, its place.
struct Draft {
  int row, point;
  double first, second;
  int block = -1;
};

/// Appends the blocks of one dot constraint: its free points, each once.
template <int dim>
void append_drafts(const Model& model, const DotConstraint& dot, int row,
                   std::vector<Draft>& drafts) {
  const auto add = [&, start = drafts.size()](int index, double first, double second) {
    const Point& point = model.points()[index];
    if (point.is_fixed()) return;
    for (std::size_t k = start; k < drafts.size(); ++k) {
      if (drafts[k].point != point.offset / dim) continue;
      drafts[k].first += first;
      drafts[k].second += second;
      return;
    }
    drafts.push_back({row, point.offset / dim, first, second});
  };
  add(dot.a, 1.0, 0.0);
  add(dot.b, -1.0, 0.0);
  add(dot.c, 0.0, 1.0);
  add(dot.d, 0.0, -1.0);
}

/// Gives every draft its place: sorted by point, for a point in the order of constraints.
/// `block_begin` arrives as zeros, points + 1 of them.
void place_blocks(std::vector<Draft>& drafts, std::vector<int>& block_begin,
                  std::vector<int>& block_row) {
  for (const Draft& draft : drafts) ++block_begin[draft.point + 1];
  std::partial_sum(block_begin.begin(), block_begin.end(), block_begin.begin());
  std::vector<int> next = block_begin;
  block_row.resize(drafts.size());
  for (Draft& draft : drafts) {
    draft.block = next[draft.point]++;
    block_row[draft.block] = draft.row;
  }
}

}  // namespace

template <int dim>
JacobianPattern<dim>::JacobianPattern(const Model& model)
    : model_row(distances_first(model)), block_begin(model.variables() / dim + 1, 0) {
  for (const Point& point : model.points()) {
    if (!point.is_fixed()) continue;
    const auto begin = point.position.begin();
    fixed_coordinates.insert(fixed_coordinates.end(), begin, begin + dim);
  }
  const std::span<const DotConstraint> dots = model.dot_constraints();
  std::vector<Draft> drafts;
  for (int i = 0; i < std::ssize(dots); ++i) {
    append_drafts<dim>(model, dots[model_row[i]], i, drafts);
  }
  place_blocks(drafts, block_begin, block_row);
  const std::vector<int> offset = extended_offsets(model);
  auto draft = drafts.begin();
  for (int i = 0; i < std::ssize(dots); ++i) {
    const DotConstraint& dot = dots[model_row[i]];
    const int a = offset[dot.a], b = offset[dot.b], c = offset[dot.c], d = offset[dot.d];
    if (is_distance(dot)) {
      distances.push_back({a, b, blocks(), blocks(), dot.value});
      Distance& distance = distances.back();
      for (; draft != drafts.end() && draft->row == i; ++draft) {
        (draft->first > 0.0 ? distance.block_a : distance.block_b) = draft->block;
      }
    } else {
      for (; draft != drafts.end() && draft->row == i; ++draft) {
        other_terms.push_back({draft->block, draft->first, draft->second});
      }
      others.push_back({a, b, c, d, dot.value, static_cast<int>(other_terms.size())});
    }
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    linear_terms.insert(linear_terms.end(), constraint.terms.begin(), constraint.terms.end());
    linears.push_back({constraint.value, static_cast<int>(linear_terms.size())});
  }
}

template <int dim>
Jacobian<dim>::Jacobian(const JacobianPattern<dim>& pattern)
    : pattern_(pattern), values_(dim * (pattern.blocks() + 1), 0.0) {}

template <int dim>
void Jacobian<dim>::evaluate(const double* q, double* phi) {
  for (const auto& distance : pattern_.distances) {
    const Vector d = difference(q, distance.a, distance.b);
    *phi++ = dot(d, d) - distance.value;  // Eq. (7)
    double* const at_a = values_.data() + dim * distance.block_a;
    double* const at_b = values_.data() + dim * distance.block_b;
    for (int k = 0; k < dim; ++k) at_a[k] = 2.0 * d[k];   // Eq. (7)
    for (int k = 0; k < dim; ++k) at_b[k] = -2.0 * d[k];  // Eq. (7)
  }
  const auto* term = pattern_.other_terms.data();
  for (const auto& other : pattern_.others) {
    const Vector ab = difference(q, other.a, other.b);
    const Vector cd = difference(q, other.c, other.d);
    *phi++ = dot(ab, cd) - other.value;  // Eq. (7)
    const auto* const end = pattern_.other_terms.data() + other.terms_end;
    for (; term < end; ++term) {
      double* const value = values_.data() + dim * term->block;
      for (int k = 0; k < dim; ++k) value[k] = term->first * cd[k] + term->second * ab[k];
    }
  }
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    double sum = 0.0;
    for (; k < linear.terms_end; ++k) {
      sum += pattern_.linear_terms[k].coefficient * q[pattern_.linear_terms[k].coordinate];
    }
    *phi++ = sum - linear.value;  // Eq. (8)
  }
}

template <int dim>
void Jacobian<dim>::subtract_transposed_dots(const double* z, double* y) const {
  const int* const row = pattern_.block_row.data();
  const double* value = values_.data();
  int block = 0;
  for (int p = 0; p < pattern_.points(); ++p, y += dim) {
    std::array<double, dim> sum{};
    for (const int end = pattern_.block_begin[p + 1]; block < end; ++block, value += dim) {
      for (int k = 0; k < dim; ++k) sum[k] += z[row[block]] * value[k];
    }
    for (int k = 0; k < dim; ++k) y[k] -= sum[k];
  }
}

template <int dim>
void Jacobian<dim>::subtract_transposed_product(const double* z, double* y) const {
  subtract_transposed_dots(z, y);
  z += pattern_.dots();
  int k = 0;
  for (const auto& linear : pattern_.linears) {
    for (; k < linear.terms_end; ++k) {
      y[pattern_.linear_terms[k].coordinate] -= pattern_.linear_terms[k].coefficient * *z;
    }
    ++z;
  }
}

template <int dim>
void Jacobian<dim>::velocity_term(const double* v, double factor, double* z) const {
  for (const auto& distance : pattern_.distances) {
    const Vector d = difference(v, distance.a, distance.b);
    *z++ = factor * (2.0 * dot(d, d));  // Eq. (7)
  }
  for (const auto& other : pattern_.others) {
    const Vector ab = difference(v, other.a, other.b);
    *z++ = factor * (2.0 * dot(ab, difference(v, other.c, other.d)));  // Eq. (7)
  }
}

namespace {

/// Every pair of free points that share a constraint, once per shared constraint.
struct Pair {
  int p, q;         ///< p < q
  int left, right;  ///< their Jacobian blocks
};

template <int dim>
std::vector<Pair> point_pairs(const JacobianPattern<dim>& jacobian) {
  std::vector<std::vector<std::pair<int, int>>> row_blocks(jacobian.dots());
  for (int p = 0; p < jacobian.points(); ++p) {
    for (int k = jacobian.block_begin[p]; k < jacobian.block_begin[p + 1]; ++k) {
      row_blocks[jacobian.block_row[k]].push_back({p, k});
    }
  }
  std::vector<Pair> pairs;
  for (const auto& blocks : row_blocks) {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      for (std::size_t j = i + 1; j < blocks.size(); ++j) {
        pairs.push_back({blocks[i].first, blocks[j].first, blocks[i].second, blocks[j].second});
      }
    }
  }
  std::ranges::stable_sort(pairs, {}, [](const Pair& pair) { return std::tuple(pair.p, pair.q); });
  return pairs;
}

/// Calls visit(row, col, product) for every product in Phi_q^T Phi_q of the linear constraints.
template <int dim, class Visit>
void visit_linear(const JacobianPattern<dim>& jacobian, Visit visit) {
  int begin = 0;
  for (const auto& linear : jacobian.linears) {
    for (int s = begin; s < linear.terms_end; ++s) {
      for (int t = begin; t < linear.terms_end; ++t) {
        const auto &row = jacobian.linear_terms[s], &col = jacobian.linear_terms[t];
        visit(row.coordinate, col.coordinate, row.coefficient * col.coefficient);
      }
    }
    begin = linear.terms_end;
  }
}

/// Offsets of the first rows of the columns of block (p, q).
template <int dim>
std::array<int, dim> block_columns(const Pattern& pattern, int p, int q) {
  std::array<int, dim> columns;
  for (int k = 0; k < dim; ++k) columns[k] = pattern.offset(dim * p, dim * q + k);
  return columns;
}

/// y = base + factor x, one column of a block, read before it is written: y may be base.
template <int dim>
void add_column(const double* base, const std::array<double, dim>& x, double factor, double* y) {
  std::array<double, dim> sum;
  for (int k = 0; k < dim; ++k) sum[k] = base[k] + factor * x[k];
  for (int k = 0; k < dim; ++k) y[k] = sum[k];
}

}  // namespace

template <int dim>
TangentPattern<dim>::TangentPattern(const Model& model, const JacobianPattern<dim>& jacobian) {
  const std::vector<Pair> pairs = point_pairs(jacobian);
  const auto is_constrained = [&](int p) {
    return jacobian.block_begin[p] < jacobian.block_begin[p + 1];
  };
  std::vector<Pattern::Position> positions = mass_positions(model);
  const auto add_block = [&](int p, int q) {
    for (int col = dim * q; col < dim * q + dim; ++col) {
      for (int row = dim * p; row < dim * p + dim; ++row) positions.push_back({row, col});
    }
  };
  for (int p = 0; p < jacobian.points(); ++p) {
    if (is_constrained(p)) add_block(p, p);
  }
  for (const Pair& pair : pairs) {
    add_block(pair.p, pair.q);
    add_block(pair.q, pair.p);
  }
  visit_linear(jacobian, [&](int row, int col, double) { positions.push_back({row, col}); });
  pattern = Pattern(model.variables(), std::move(positions));

  for (int p = 0; p < jacobian.points(); ++p) {
    if (!is_constrained(p)) continue;
    diagonals.push_back(
        {jacobian.block_begin[p], jacobian.block_begin[p + 1], block_columns<dim>(pattern, p, p)});
  }
  const Pair* last = nullptr;
  for (const Pair& pair : pairs) {
    const bool repeated = last != nullptr && last->p == pair.p && last->q == pair.q;
    (repeated ? further_couplings : couplings)
        .push_back({pair.left, pair.right, block_columns<dim>(pattern, pair.p, pair.q),
                    block_columns<dim>(pattern, pair.q, pair.p)});
    last = &pair;
  }
}

template <int dim>
Tangent<dim>::Tangent(const Model& model, const JacobianPattern<dim>& jacobian,
                      const TangentPattern<dim>& pattern, double factor)
    : pattern_(pattern), factor_(factor), constant_(pattern.pattern.entries(), 0.0) {
  add_mass(model, pattern.pattern, constant_);
  visit_linear(jacobian, [&](int row, int col, double product) {
    constant_[pattern.pattern.offset(row, col)] += factor * product;
  });
  values_ = constant_;
}

template <int dim>
void Tangent<dim>::assemble(const Jacobian<dim>& jacobian) {
  const double* const constant = constant_.data();
  double* const value = values_.data();
  for (const auto& diagonal : pattern_.diagonals) {
    std::array<std::array<double, dim>, dim> product{};
    for (int block = diagonal.begin; block < diagonal.end; ++block) {
      const double* const j = jacobian.block(block);
      for (int col = 0; col < dim; ++col) {
        for (int row = 0; row < dim; ++row) product[col][row] += j[row] * j[col];
      }
    }
    for (int col = 0; col < dim; ++col) {
      const int at = diagonal.columns[col];
      add_column<dim>(constant + at, product[col], factor_, value + at);  // Eq. (5)
    }
  }
  const auto couple = [&](const auto& coupling, const double* base) {
    std::array<double, dim> left, right;  // filled by loops: std::copy_n is slower here
    for (int k = 0; k < dim; ++k) left[k] = jacobian.block(coupling.left)[k];
    for (int k = 0; k < dim; ++k) right[k] = jacobian.block(coupling.right)[k];
    for (int col = 0; col < dim; ++col) {
      const int above = coupling.above[col], below = coupling.below[col];
      add_column<dim>(base + above, left, factor_ * right[col], value + above);  // Eq. (5)
      add_column<dim>(base + below, right, factor_ * left[col], value + below);  // Eq. (5)
    }
  };
  for (const auto& coupling : pattern_.couplings) couple(coupling, constant);
  for (const auto& coupling : pattern_.further_couplings) couple(coupling, value);
}

template struct JacobianPattern<2>;
template struct JacobianPattern<3>;
template class Jacobian<2>;
template class Jacobian<3>;
template struct TangentPattern<2>;
template struct TangentPattern<3>;
template class Tangent<2>;
template class Tangent<3>;

}  // namespace mbs::csc_klu
