// Orders of elimination of a graph, before anything is known about numbers.
#pragma once

#include <vector>

namespace mbs::compiled_ldl {

/// Neighbours of each node, sorted, each once, without the node itself. A chain 0 - 1 - 2 - 3, of
/// the cliques {0, 1}, {1, 2} and {2, 3}, is {1}, {0, 2}, {1, 3}, {2}.
using Graph = std::vector<std::vector<int>>;

/// The graph in which the nodes of each clique are neighbours.
Graph graph_of(int nodes, const std::vector<std::vector<int>>& cliques);

/// Which of several nodes of least degree goes first: the one that has waited longest, so that
/// independent branches grow side by side, or the latest one.
enum class Tie { longest, latest };

/// Approximate minimum degree: the nodes in order of elimination. That of the chain is 0, 3, 1, 2
/// with Tie::longest, 3, 2, 1, 0 with Tie::latest.
std::vector<int> minimum_degree(const Graph& graph, Tie tie);

/// Each component by distance from one of its ends, as Cuthill and McKee have it, but taken from
/// both ends to the middle by turns: two independent branches of nearly equal length. That of the
/// chain is 0, 3, 1, 2.
std::vector<int> from_both_ends(const Graph& graph);

}  // namespace mbs::compiled_ldl
