// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/run_scope.hpp"
#include "metrics/measures.hpp"

#include <span>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kNoPlace = -1;

/// Returns the elimination tree: for each place k of the order, the first later place whose row of the factor
/// has an entry in column k; kNoPlace for roots (Liu 1990, The role of elimination trees in sparse
/// factorization).
std::vector<Index> elimination_tree(GraphRef graph, const Permutation& order) {
  std::vector<Index> parent(static_cast<std::size_t>(graph.size()), kNoPlace);
  std::vector<Index> ancestor(parent);  // an ancestor of each node so far; shortens paths
  for (Index row = 0; row < graph.size(); ++row) {
    poll_in_loop(row);
    for (const Index neighbour : graph[order.new_to_old()[row]]) {
      for (Index k = order.old_to_new()[neighbour]; k < row && k != kNoPlace;) {
        const Index next = ancestor[k];
        ancestor[k] = row;
        if (next == kNoPlace) parent[k] = row;
        k = next;
      }
    }
  }
  return parent;
}

/// A tree numbered in postorder: the numbers of a node's descendants directly precede the node's number.
struct Postordered {
  std::vector<Index> number;            ///< number of each node of the given tree
  std::vector<Index> parent;            ///< parent of each node, by number
  std::vector<Index> first_descendant;  ///< by number: the smallest number in the node's subtree
  std::vector<Index> depth;             ///< depth of each node, by number; 0 for roots
};

/// Numbers a tree in postorder. `parent[k]`: the parent of node k, a node after k, or kNoPlace.
Postordered postordered(std::span<const Index> parent) {
  const Index n = index_size(parent);
  std::vector<Index> size(parent.size(), 1);
  for (Index k = 0; k < n; ++k) {
    if (parent[k] != kNoPlace) size[parent[k]] += size[k];
  }
  Postordered tree;
  tree.number.resize(parent.size());
  tree.parent.resize(parent.size());
  tree.first_descendant.resize(parent.size());
  tree.depth.resize(parent.size());
  std::vector<Index> next(parent.size());  // first number of the subtree of each node's next child
  Index next_of_roots = 0;
  for (Index k = n - 1; k >= 0; --k) {
    Index& first = parent[k] == kNoPlace ? next_of_roots : next[parent[k]];
    const Index number = first + size[k] - 1;
    next[k] = first;
    tree.number[k] = number;
    tree.first_descendant[number] = first;
    tree.parent[number] = parent[k] == kNoPlace ? kNoPlace : tree.number[parent[k]];
    tree.depth[number] = parent[k] == kNoPlace ? 0 : tree.depth[tree.parent[number]] + 1;
    first += size[k];
  }
  return tree;
}

/// Sets of nodes; each set is named by one of its nodes.
class DisjointSets {
 public:
  explicit DisjointSets(Index n) : towards_(static_cast<std::size_t>(n)) {
    for (Index k = 0; k < n; ++k) towards_[k] = k;
  }

  Index name_of(Index k) {
    while (towards_[k] != k) {
      towards_[k] = towards_[towards_[k]];
      k = towards_[k];
    }
    return k;
  }

  /// Joins the set named `k` to the set named `name`.
  void join(Index k, Index name) { towards_[k] = name; }

 private:
  std::vector<Index> towards_;
};

}  // namespace

Offset factor_entries(GraphRef graph, const Permutation& order) {
  const Postordered tree = postordered(elimination_tree(graph, order));
  const Index n = graph.size();
  std::vector<Index> vertex(static_cast<std::size_t>(n));
  for (Index k = 0; k < n; ++k) vertex[tree.number[k]] = order.new_to_old()[k];

  // The entries of a row are the nodes of a subtree below the row's node. They are counted leaf by leaf: the
  // path from the leaf towards the row, up to the node where it meets the path from the previous leaf.
  Offset entries = 0;
  std::vector<Index> last_neighbour(static_cast<std::size_t>(n), kNoPlace);
  std::vector<Index> last_leaf(static_cast<std::size_t>(n), kNoPlace);
  DisjointSets finished(n);
  for (Index j = 0; j < n; ++j) {
    poll_in_loop(j);
    for (const Index neighbour : graph[vertex[j]]) {
      const Index row = tree.number[order.old_to_new()[neighbour]];
      if (row <= j) continue;
      if (tree.first_descendant[j] > last_neighbour[row]) {  // j is a leaf of the row's subtree
        const Index meeting = last_leaf[row] == kNoPlace ? row : finished.name_of(last_leaf[row]);
        entries += tree.depth[j] - tree.depth[meeting];
        last_leaf[row] = j;
      }
      last_neighbour[row] = j;
    }
    if (tree.parent[j] != kNoPlace) finished.join(j, tree.parent[j]);
  }
  return entries;
}

}  // namespace meshorder
