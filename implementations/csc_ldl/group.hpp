// Constraints or force elements of one kind, component by component.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "coordinates.hpp"

namespace mbs::csc_ldl {

/// Each member has one vector between two points, or two between four, and a gradient that belongs
/// to each vector: it acts at the vector's first point, its negative at the second. A distance has
/// u = r_a - r_b and the gradient 2 u; a dot constraint u and w, gradients w and u.
///
/// Component c of member k is at c * count + k: loops over k are the tight ones. Component
/// j * dimension + axis is that of vector j.
struct Group {
  /// What a member has at one variable.
  struct End {
    int variable, component;
    bool negative;
  };

  int count = 0, components = 0;
  std::vector<int> plus, minus;  ///< where the coordinates of a vector's points are
  std::vector<double> gradient;
  int first_force = 0, first_matrix = 0;  ///< of its parts among all

  Group() = default;
  Group(int members, int vectors, const Coordinates& at)
      : count(members),
        components(vectors * at.dimension),
        dimension_(at.dimension),
        variables_(at.variables) {
    plus.resize(components * count);
    minus = plus;
    gradient.resize(components * count);
  }
  void set_points(int k, int vector, int a, int b, const Coordinates& at) {
    for (int axis = 0; axis < dimension_; ++axis) {
      plus[(vector * dimension_ + axis) * count + k] = at(a, axis);
      minus[(vector * dimension_ + axis) * count + k] = at(b, axis);
    }
  }
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] std::vector<End> ends(int k) const {
    std::vector<End> all;
    for (int c = 0; c < components; ++c) {
      if (plus[c * count + k] < variables_) all.push_back({plus[c * count + k], c, false});
      if (minus[c * count + k] < variables_) all.push_back({minus[c * count + k], c, true});
    }
    return all;
  }

  /// Parts of forces: a component times a factor, and its negative. Both are stored, so that sums
  /// need no signs.
  [[nodiscard]] int force_parts() const { return 2 * components * count; }
  [[nodiscard]] int force_part(int k, const End& end) const {
    return first_force + (2 * end.component + end.negative) * count + k;
  }
  /// Parts of the tangent: products of two components, and their negatives.
  [[nodiscard]] int matrix_parts() const { return components * (components + 1) * count; }
  [[nodiscard]] int matrix_part(int k, const End& a, const End& b) const {
    const int low = std::min(a.component, b.component), high = std::max(a.component, b.component);
    return first_matrix + (high * (high + 1) + 2 * low + (a.negative != b.negative)) * count + k;
  }

  /// Calls visit(i, j, part) for what (i, j) of the tangent sums up, (j, i) apart.
  template <class Visit>
  void visit_products(Visit visit) const {
    for (int k = 0; k < count; ++k) {
      const std::vector<End> all = ends(k);
      for (const End& a : all) {
        for (const End& b : all) visit(a.variable, b.variable, matrix_part(k, a, b));
      }
    }
  }

  /// The difference that component c of member k is.
  [[nodiscard]] double difference(const double* x, int c, int k) const {
    return x[plus[c * count + k]] - x[minus[c * count + k]];
  }
  /// y_k += gradient_k . x, a row of Phi_q times x. x counts at fixed points, too.
  void add_contracted(const double* x, double* y) const {
    with_components([&](auto components) {
#pragma GCC ivdep
      for (int k = 0; k < count; ++k) {
        double sum = y[k];
        for (int c = 0; c < components; ++c) sum += gradient[c * count + k] * difference(x, c, k);
        y[k] = sum;
      }
    });
  }
  /// Gradients times factor (gradient_k . x + y_k).
  void write_reactions(double factor, const double* x, const double* y, double* parts) const {
    with_components([=, this](auto components) {
      const int n = count;
      const double* all = gradient.data();
      const int *from = plus.data(), *to = minus.data();
      double* part = parts + first_force;
#pragma GCC ivdep
      for (int k = 0; k < n; ++k) {
        double g[components], sum = y[k];
        for (int c = 0; c < components; ++c) {
          g[c] = all[c * n + k];
          sum += g[c] * (x[from[c * n + k]] - x[to[c * n + k]]);
        }
        sum *= factor;
        for (int c = 0; c < components; ++c) {
          part[2 * c * n + k] = sum * g[c];
          part[(2 * c + 1) * n + k] = -sum * g[c];
        }
      }
    });
  }
  /// Gradients times factor(k).
  template <class Factor>
  void write_forces(Factor factor, double* parts) const {
    with_components([&](auto components) {
      const int n = count;
      const double* g = gradient.data();
      double* part = parts + first_force;
#pragma GCC ivdep
      for (int k = 0; k < n; ++k) {
        for (int c = 0; c < components; ++c) {
          const double value = factor(k) * g[c * n + k];
          part[2 * c * n + k] = value;
          part[(2 * c + 1) * n + k] = -value;
        }
      }
    });
  }
  /// factor(k) gradient gradient^T.
  template <class Factor>
  void write_products(Factor factor, double* parts) const {
    // `factor` by value: behind a reference, GCC has to expect that what is written changes it.
    with_components([this, factor, parts](auto components) {
      const int n = count;
      const double* all = gradient.data();
      double* part = parts + first_matrix;
#pragma GCC ivdep
      for (int k = 0; k < n; ++k) {
        const double scale = factor(k);
        double g[components];
        for (int c = 0; c < components; ++c) g[c] = all[c * n + k];
        for (int high = 0; high < components; ++high) {
#pragma GCC unroll 8  // early enough for the loop over members to be vectorized
          for (int low = 0; low <= high; ++low) {
            const double value = scale * (g[high] * g[low]);
            part[(high * (high + 1) + 2 * low) * n + k] = value;
            part[(high * (high + 1) + 2 * low + 1) * n + k] = -value;
          }
        }
      }
    });
  }

 private:
  /// Loops over components are unrolled: few members are common, and one loop over them is quicker
  /// than one for each component.
  template <class Function>
  void with_components(Function f) const {
    switch (components) {
      case 2:
        return f(std::integral_constant<int, 2>{});
      case 3:
        return f(std::integral_constant<int, 3>{});
      case 4:
        return f(std::integral_constant<int, 4>{});
      case 6:
        return f(std::integral_constant<int, 6>{});
    }
    throw std::logic_error("components of a group are 2, 3, 4 or 6");
  }

  int dimension_ = 0, variables_ = 0;
};

}  // namespace mbs::csc_ldl
