// SPDX-License-Identifier: Apache-2.0
// The only file that includes Scotch.
#include "tools/parts/scotch_graph.h"

#include <cstdint>
#include <cstdio>
#include <mutex>
#include <new>

// Expects cstdint and cstdio.
#include <scotch.h>

namespace tetwright {

namespace {

static_assert(sizeof(SCOTCH_Num) == sizeof(std::int32_t),
              "the headers of Scotch with 32-bit numbers are needed");

/// Our graphs are valid, so that Scotch fails only for lack of memory.
void require_scotch(int status) {
  if (status != 0) throw std::bad_alloc();
}

/// A Scotch object, released on destruction.
template <class Object, int (*init)(Object*), void (*release)(Object*)>
class Owned {
 public:
  Owned() { require_scotch(init(&object_)); }
  ~Owned() { release(&object_); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  Object* get() { return &object_; }

 private:
  Object object_;
};
using ScotchGraph = Owned<SCOTCH_Graph, SCOTCH_graphInit, SCOTCH_graphExit>;
using ScotchStrategy = Owned<SCOTCH_Strat, SCOTCH_stratInit, SCOTCH_stratExit>;
using ScotchContext = Owned<SCOTCH_Context, SCOTCH_contextInit, SCOTCH_contextExit>;

}  // namespace

std::vector<PartNumber> scotch_parts(const WeightedGraph& graph, PartNumber parts, double imbalance) {
  static std::mutex one_at_a_time;  // its parser of strategies has global variables
  const std::lock_guard lock(one_at_a_time);
  const auto vertices = static_cast<SCOTCH_Num>(graph.starts.size() - 1);
  const auto list = [](const std::vector<std::int32_t>& items) {
    return items.empty() ? nullptr : items.data();
  };
  ScotchContext context;
  constexpr SCOTCH_Num on = 1, seed = 1;
  require_scotch(SCOTCH_contextOptionSetNum(context.get(), SCOTCH_OPTIONNUMDETERMINISTIC, on));
  require_scotch(SCOTCH_contextOptionSetNum(context.get(), SCOTCH_OPTIONNUMRANDOMFIXEDSEED, on));
  require_scotch(SCOTCH_contextRandomClone(context.get()));  // generator of its own
  SCOTCH_contextRandomSeed(context.get(), seed);
  SCOTCH_contextRandomReset(context.get());
  require_scotch(SCOTCH_contextThreadSpawn(context.get(), 1, nullptr));
  ScotchGraph own, bound;
  require_scotch(SCOTCH_graphBuild(
      own.get(), 0, vertices, graph.starts.data(), nullptr, list(graph.vertex_weights), nullptr,
      static_cast<SCOTCH_Num>(graph.neighbours.size()), graph.neighbours.data(), list(graph.edge_weights)));
  require_scotch(SCOTCH_contextBindGraph(context.get(), own.get(), bound.get()));
  ScotchStrategy strategy;
  require_scotch(SCOTCH_stratGraphMapBuild(strategy.get(), SCOTCH_STRATBALANCE,
                                           static_cast<SCOTCH_Num>(parts), imbalance));
  std::vector<SCOTCH_Num> part_of(static_cast<std::size_t>(vertices));
  require_scotch(
      SCOTCH_graphPart(bound.get(), static_cast<SCOTCH_Num>(parts), strategy.get(), part_of.data()));
  return {part_of.begin(), part_of.end()};
}

}  // namespace tetwright
