// OPEN against a list that is searched from end to end.
#include "planner/search/open_list.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <utility>
#include <vector>

#include "property_tests/support/property.hpp"

namespace sipplab::open_list_laws {
namespace {

/// What a search does to OPEN: queue an entry (pop when there is none), or take one out.
struct Step {
  bool push = true;
  int f = 0;          ///< few values, so that ties are common
  int arrival_s = 0;  ///< few values as well
};

std::ostream& operator<<(std::ostream& out, const Step& step) {
  if (!step.push) return out << "pop";
  return out << "push f " << step.f << " arrival " << step.arrival_s;
}

rc::Gen<std::vector<Step>> any_steps() {
  const auto step = rc::gen::apply(
      [](int choice, int f, int arrival_s) {
        return Step{choice < 3, f, arrival_s};
      },
      rc::gen::inRange(0, 5), rc::gen::inRange(0, 5), rc::gen::inRange(0, 4));
  return rc::gen::resize(5 * rc::kNominalSize, rc::gen::container<std::vector<Step>>(step));
}

/// The entry that the contract names: least f, then greatest arrival, then first come.
std::size_t first_of(const std::vector<std::pair<Step, NodeId>>& waiting) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < waiting.size(); ++i) {
    const Step& a = waiting[i].first;
    const Step& b = waiting[best].first;
    if (a.f < b.f || (a.f == b.f && a.arrival_s > b.arrival_s)) best = i;
  }
  return best;
}

void same_as_a_list(const std::vector<Step>& steps) {
  Arena arena;
  OpenList open(arena);
  std::vector<std::pair<Step, NodeId>> waiting;  // as they came
  NodeId next = 0;
  const auto take = [&] {
    const std::size_t first = first_of(waiting);
    const OpenList::Entry entry = open.pop_min();
    RC_ASSERT(entry.node == waiting[first].second);
    RC_ASSERT(entry.is_lazy() == (entry.node % 2 == 1));
    waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(first));
  };
  for (const Step& step : steps) {
    RC_ASSERT(open.empty() == waiting.empty());
    if (step.push) {
      // Lazy successors and settled nodes by turns: they queue as one.
      if (next % 2 == 1) {
        open.push_lazy(next, step.f, step.arrival_s, 0, kNoNode);
      } else {
        open.push(next, step.f, step.arrival_s);
      }
      waiting.emplace_back(step, next++);
    } else if (!waiting.empty()) {
      take();
    }
  }
  RC_CLASSIFY(waiting.size() > 20, "more than 20 at the end");
  while (!waiting.empty()) take();
  RC_ASSERT(open.empty());
}

const PropertyRoom room("open_list", [] {
  const bool passed = property("pop_min: the least f, of these the greatest arrival, of these the first come",
                               [] { same_as_a_list(*any_steps()); });
  return passed;
});

}  // namespace
}  // namespace sipplab::open_list_laws
