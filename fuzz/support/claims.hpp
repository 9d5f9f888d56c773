// What the targets claim, and what their inputs came to. Each check is counted, so that a
// record shows whether a claim was put to the test at all. Counts go to the file of
// bench/campaigns/counts.hpp that the environment names, if any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace sipplab::fuzz {

/// What may not be. The name is part of a finding's signature.
enum class Claim : std::uint8_t {
  kRefusalIsOneLine,        ///< a refused text is refused in one line, with a line number of that text
  kReadsBackEqual,          ///< read(write(read(x))) == read(x)
  kReadsWhatItSays,         ///< the plainest reader takes the same from an accepted text
  kMemoryInProportion,      ///< reading takes no more memory than a text of this size is due
  kResultIsWhole,           ///< solved: a trajectory for each robot; else none
  kPlanIsValid,             ///< the validator accepts every plan, its start-safe intervals too
  kPlanIsCertified,         ///< interval arithmetic proves no overlap of a valid plan
  kCostsAreArrivals,        ///< makespan and flowtime are what the trajectories say
  kSameInputSamePlan,       ///< the same case gives the same plan, trace and counts of work
  kFinalOrderExplainsPlan,  ///< the final order without re-scheduling gives the same trajectories
  kUnreachableIsUnsolved,   ///< a goal that cannot be reached has no plan
  kLoneRobotIsExact,        ///< one robot alone: solved and as short as breadth-first search says
  kReschedulingLosesNone,   ///< re-scheduling solves in one try what is solved without
  kLastRobotAtZero,         ///< start-safe interval 0: without the last robot the others move the same
  kLastGoalIsFree,          ///< fifo: the last robot's goal is nothing to the others
  kBudgetIsKept,            ///< no more expansions and restarts than were allowed
  kTraceFollowsRules,       ///< each next order is the one that the method names; none is tried twice
  kVerdictIsInvariant,      ///< the verdict survives turning, reflection, slower time, and fewer robots
  kPlantedDefectIsFound,    ///< the validator names what was broken on purpose
  kClosedFormIsRight,       ///< unsafe times agree with distances and bisection
  kSightIsExact,            ///< line of sight agrees with whole numbers, both ways
  kTwinsAgree,              ///< fast path and plain twin give the same
  kCompleteIsComplete,      ///< LaCAM solves exactly what an exhaustive search solves
  kImprovementIsNoWorse,    ///< an improved plan costs no more than the plan that was given
};
inline constexpr std::size_t kClaims = 24;
std::string_view name(Claim claim);

/// What an input turned out to be.
enum class Event : std::uint8_t {
  kInputs,           ///< every input
  kAccepted,         ///< a text that is what the target reads
  kRefused,          ///< a text that is not
  kValidInstances,   ///< a case that keeps the rules of instances
  kTwoRobots,        ///< ... with two robots or more
  kSolved,           ///< a plan was found
  kFailed,           ///< the method ended without one
  kLimited,          ///< a limit struck first
  kRescheduled,      ///< more than one order was tried
  kDeterministic,    ///< ... by deterministic re-scheduling
  kRandom,           ///< ... by random re-scheduling
  kAnyAngle,         ///< any-angle was on
  kStartsProtected,  ///< a start-safe interval above 0, two robots or more
  kObstacles,        ///< something moved on its own
  kMixedBodies,      ///< robots of different sizes or speeds
  kComparisons,      ///< comparisons with a slow twin
};
inline constexpr std::size_t kEvents = 16;
std::string_view name(Event event);

void count(Event event);

/// Counts the check; if the condition is false, prints "broken claim: NAME: detail" and
/// aborts.
void require(Claim claim, bool condition, const char* detail);
void require(Claim claim, bool condition, const std::string& detail);

}  // namespace sipplab::fuzz
