// Smaller texts; see text_reducer.hpp.
#include "property_tests/support/text_reducer.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "planner/io/case_codec.hpp"
#include "property_tests/support/case_shrinker.hpp"

namespace sipplab {
namespace {

/// The case with one place moved a cell to the left or up, for each place that can be: then
/// the map can be cut. Obstacles move as a whole.
std::vector<PlanCase> nearer_cases(const PlanCase& plan_case) {
  std::vector<PlanCase> nearer;
  const auto offer = [&](auto&& places_of) {
    for (const Cell step : {Cell{1, 0}, Cell{0, 1}}) {
      PlanCase moved = plan_case;
      bool on_map = true;  // obstacles may leave it, and would go on for ever
      for (Cell* place : places_of(moved.instance)) {
        *place = {place->x - step.x, place->y - step.y};
        on_map = on_map && moved.instance.map.contains(*place);
      }
      if (on_map && !find_error(moved.instance)) nearer.push_back(std::move(moved));
    }
  };
  for (std::size_t i = 0; i < plan_case.instance.agents.size(); ++i) {
    offer([i](Instance& it) { return std::vector<Cell*>{&it.agents[i].start, &it.agents[i].goal}; });
    offer([i](Instance& it) { return std::vector<Cell*>{&it.agents[i].start}; });
    offer([i](Instance& it) { return std::vector<Cell*>{&it.agents[i].goal}; });
  }
  for (std::size_t i = 0; i < plan_case.instance.obstacles.size(); ++i) {
    offer([i](Instance& it) {
      Trajectory& trajectory = it.obstacles[i].trajectory;
      std::vector<Cell*> places{&trajectory.start};
      for (TimedMotion& motion : trajectory.motions) places.insert(places.end(), {&motion.from, &motion.to});
      return places;
    });
  }
  return nearer;
}

class Reducer {
 public:
  Reducer(std::string text, const StillBreaks& still_breaks, std::size_t max_tries)
      : still_breaks_(still_breaks), max_tries_(max_tries) {
    best_.text = std::move(text);
  }

  Reduction run() {
    if (reduce_as_case()) return std::move(best_);
    while (leave_out(true) || leave_out(false) || plainer_bytes()) {
    }
    return std::move(best_);
  }

 private:
  bool exhausted() const { return best_.tries >= max_tries_; }

  /// Whether the text was taken.
  bool offer(std::string text) {
    if (exhausted() || text == best_.text) return false;
    ++best_.tries;
    if (!still_breaks_(text)) return false;
    ++best_.steps;
    best_.text = std::move(text);
    return true;
  }

  /// False if the text is no case, or breaks only as it is written.
  bool reduce_as_case() {
    std::optional<PlanCase> plan_case = decode_case(best_.text);
    if (!plan_case || find_error(plan_case->instance)) return false;
    const std::string text = encode_case(*plan_case);
    if (text != best_.text && !offer(text)) return false;
    while (take_first(simpler_cases(*plan_case), *plan_case) ||
           take_first(nearer_cases(*plan_case), *plan_case)) {
    }
    return true;
  }

  /// Whether one of them still breaks; it takes the place of the case.
  bool take_first(std::vector<PlanCase> offers, PlanCase& plan_case) {
    for (PlanCase& smaller : offers) {
      if (!offer(encode_case(smaller))) continue;
      plan_case = std::move(smaller);
      return true;
    }
    return false;
  }

  /// Where pieces begin, and the end of the text.
  std::vector<std::size_t> pieces(bool by_line) const {
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < best_.text.size(); ++i) {
      if (!by_line || i == 0 || best_.text[i - 1] == '\n') begins.push_back(i);
    }
    begins.push_back(best_.text.size());
    return begins;
  }

  /// Runs of lines or bytes, halves first, single ones last. Whether anything went.
  bool leave_out(bool by_line) {
    bool any = false;
    std::vector<std::size_t> begins = pieces(by_line);
    for (std::size_t length = std::max<std::size_t>(1, (begins.size() - 1) / 2); length > 0; length /= 2) {
      for (std::size_t i = 0; i + length < begins.size() && !exhausted();) {
        std::string text = best_.text;
        text.erase(begins[i], begins[i + length] - begins[i]);
        if (offer(std::move(text))) {
          begins = pieces(by_line);
          any = true;
        } else {
          i += length;
        }
      }
    }
    return any;
  }

  /// What a person reads more easily in place of digits, letters and everything else.
  bool plainer_bytes() {
    bool any = false;
    for (std::size_t i = 0; i < best_.text.size() && !exhausted(); ++i) {
      for (const char plain : {'0', '1', 'a', ' '}) {
        if (best_.text[i] == plain) break;
        std::string text = best_.text;
        text[i] = plain;
        if (!offer(std::move(text))) continue;
        any = true;
        break;
      }
    }
    return any;
  }

  const StillBreaks& still_breaks_;
  std::size_t max_tries_;
  Reduction best_;
};

}  // namespace

Reduction reduce_text(const std::string& text, const StillBreaks& still_breaks, std::size_t max_tries) {
  return Reducer(text, still_breaks, max_tries).run();
}

}  // namespace sipplab
