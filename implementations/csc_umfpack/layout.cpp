// Set-up: lowers points and constraints.
#include "layout.hpp"

#include <algorithm>

namespace mbs::csc_umfpack {

PointLayout::PointLayout(const Model& model) : variables(model.variables()) {
  for (const Point& point : model.points()) {
    const int next_fixed = variables + static_cast<int>(fixed.size());
    offsets.push_back(point.is_fixed() ? next_fixed : point.offset);
    if (!point.is_fixed()) continue;
    fixed.insert(fixed.end(), point.position.begin(), point.position.begin() + model.dimension());
  }
}

std::vector<PointLayout::Signs> PointLayout::signs(std::span<const int> points) const {
  constexpr double kInAb[] = {1.0, -1.0, 0.0, 0.0}, kInCd[] = {0.0, 0.0, 1.0, -1.0};
  std::vector<Signs> result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!is_free(points[k])) continue;  // a fixed point has no columns
    const int offset = offsets[points[k]];
    auto found = std::ranges::find(result, offset, &Signs::offset);
    if (found == result.end()) found = result.insert(found, {offset, 0.0, 0.0});
    found->in_ab += kInAb[k];
    found->in_cd += kInCd[k];
  }
  return result;
}

JacobianLayout::JacobianLayout(const Model& model, const PointLayout& points) {
  const auto constraints = model.dot_constraints();
  std::vector<int> link_order, dot_order;  // `order` starts with the pins
  for (int k = 0; k < static_cast<int>(constraints.size()); ++k) {
    const DotConstraint& dot = constraints[k];
    // Free before fixed.
    const auto [a, b] = std::minmax(points.offsets[dot.a], points.offsets[dot.b]);
    if (dot.a != dot.c || dot.b != dot.d || a == b || a >= points.variables) {
      dot_order.push_back(k);
    } else if (b >= points.variables) {
      order.push_back(k);
      pins.push_back({a, b, dot.value});
    } else {
      link_order.push_back(k);
      links.push_back({a, b, dot.value});
    }
  }
  int row = 0;
  for (const Distance& pin : pins) blocks.push_back({pin.a, row++});
  for (const Distance& link : links) {
    blocks.push_back({link.a, row});
    blocks.push_back({link.b, row++});
  }
  order.insert(order.end(), link_order.begin(), link_order.end());
  for (const int k : dot_order) {
    const DotConstraint& dot = constraints[k];
    dots.push_back(add_product(points, {dot.a, dot.b, dot.c, dot.d}, dot.value));
    order.push_back(k);
  }
  // From here on, rows are those of the Model.
  for (const BilinearConstraint& each : model.bilinear_constraints()) {
    bilinears.push_back(
        {add_product(points, {each.a, each.b, each.c, each.d}, each.value), each.B});
    order.push_back(rows());
  }
  for (const LinearConstraint& linear : model.linear_constraints()) add_linear(linear);
}

JacobianLayout::Dot JacobianLayout::add_product(const PointLayout& points,
                                                const std::array<int, 4>& abcd, double value) {
  const int first = static_cast<int>(blocks.size());
  for (const auto& point : points.signs(abcd)) {
    blocks.push_back({point.offset, rows()});
    signs.push_back(point);
  }
  return {points.offsets[abcd[0]],
          points.offsets[abcd[1]],
          points.offsets[abcd[2]],
          points.offsets[abcd[3]],
          value,
          first,
          static_cast<int>(blocks.size())};
}

void JacobianLayout::add_linear(const LinearConstraint& linear) {
  const int first = static_cast<int>(terms.size());
  terms.insert(terms.end(), linear.terms.begin(), linear.terms.end());
  linears.push_back({first, static_cast<int>(terms.size()), linear.value});
  order.push_back(rows());
}

double& JacobianLayout::value(int row) {
  std::size_t k = row;
  if (k < pins.size()) return pins[k].value;
  k -= pins.size();
  if (k < links.size()) return links[k].value;
  k -= links.size();
  if (k < dots.size()) return dots[k].value;
  k -= dots.size();
  if (k < bilinears.size()) return bilinears[k].value;
  return linears[k - bilinears.size()].value;
}

}  // namespace mbs::csc_umfpack
