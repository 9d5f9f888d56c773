// The gate from end to end: workers that answer as they are told to, so that what the comparison ought to say
// is known; and the worker itself, asked line by line.
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bench/gate/comparison.hpp"
#include "bench/gate/protocol.hpp"
#include "bench/gate/worker.hpp"
#include "bench/judge/evidence.hpp"
#include "bench/sweep/run_instance.hpp"
#include "planner/io/text_file.hpp"
#include "property_tests/support/generators.hpp"
#include "property_tests/support/histories.hpp"
#include "property_tests/support/property.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab::bench::gate_laws {
namespace {

using db::any_flag;
using db::any_whole;
using nlohmann::json;

/// Each starts some thirty processes.
constexpr int kComparisons = (kCasesOfHistories + 39) / 40;
constexpr int kFewer = (kCasesOfHistories + 3) / 4;

/// The cases of the gate's own suite, made once.
const GateCases& cases() {
  static const GateCases made = [] {
    auto built = GateCases::make("gate", 1, {false, false, false});
    if (!built) RC_FAIL(built.error());
    return std::move(*built);
  }();
  return made;
}

bool close(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

/// A worker that gives these answers, one for each job.
void write_worker(const std::filesystem::path& file, const std::string& compiler,
                  const std::vector<WorkerAnswer>& answers) {
  WorkerGreeting greeting;
  greeting.build.compiler = compiler;
  greeting.build.binary_hash = compiler;
  greeting.program = file.string();
  std::string script = "#!/bin/sh\njob=0\n";
  for (std::size_t i = 0; i < answers.size(); ++i)
    script += "answer_" + std::to_string(i) + "='" + to_json(answers[i]).dump() + "'\n";
  std::map<std::size_t, std::string> hashes;
  for (const GateJob& job : cases().jobs()) hashes[job.instance] = job.row.content_hash;
  for (const auto& [number, hash] : hashes) script += "hash_" + std::to_string(number) + "=" + hash + "\n";
  script += "echo '" + to_json(greeting).dump() + "'\n" +
            R"sh(while IFS= read -r line; do
  case "$line" in
  *'"load"'*) file=${line##*/}; file=${file%%.xml*}; eval "hash=\$hash_$file"; echo "{\"instance\":$file,\"content_hash\":\"$hash\"}" ;;
  *'"options"'*) echo "{\"job\":$job}"; job=$((job + 1)) ;;
  *) number=${line##*'"plan":'}; number=${number%%[!0-9]*}; eval "echo \"\$answer_$number\"" ;;
  esac
done
)sh";
  RC_ASSERT(!write_file(file.string(), script).has_value());
  RC_ASSERT(chmod(file.c_str(), 0755) == 0);
}

/// Of the middle half.
double middle_mean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0;
  const std::size_t cut = values.size() / 4;
  for (std::size_t i = cut; i < values.size() - cut; ++i) sum += values[i];
  return sum / static_cast<double>(values.size() - 2 * cut);
}

void comparisons_say_what_workers_said() {
  const ScratchFolder folder;
  const std::vector<GateCell>& cells = cases().cells();
  const std::vector<GateJob>& jobs = cases().jobs();
  std::vector<double> ratios;
  for (std::size_t i = 0; i < cells.size(); ++i)
    ratios.push_back(
        std::vector<double>{1, 1, 1.25, 0.75, 1.0078125}[static_cast<std::size_t>(any_whole(0, 4))]);
  const auto growth = any_whole(0, 2) << 20;
  std::vector<WorkerAnswer> base;
  std::vector<WorkerAnswer> head;
  std::size_t differing = 0;
  std::vector<double> all;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    WorkerAnswer answer;
    answer.row = db::any_result();
    answer.row.status = db::ResultStatus::kSolved;
    answer.row.valid = true;
    answer.row.makespan_s = 8;
    answer.row.flowtime_s = 64;
    answer.row.plan_hash = 1;
    answer.row.limit.clear();
    answer.row.message.clear();
    answer.row.peak_memory_bytes = (3 << 20);
    answer.cpu_ns = 1'280'000 * (1 + static_cast<std::int64_t>(i));
    base.push_back(answer);
    const double ratio = ratios[jobs[i].cell];
    answer.cpu_ns = static_cast<std::int64_t>(static_cast<double>(answer.cpu_ns) * ratio);
    answer.row.peak_memory_bytes = (3 << 20) + growth;
    if (any_whole(0, 9) == 0) {
      answer.row.plan_hash = 2;
      ++differing;
    }
    head.push_back(answer);
    all.push_back(std::log(ratio));
  }
  write_worker(folder.path() / "base", "base", base);
  write_worker(folder.path() / "head", "head", head);
  GateRequest request;
  request.builds = {(folder.path() / "base").string(), (folder.path() / "head").string(), {}};
  request.pairs = 9;
  request.fresh_pairs = 5;
  request.budget = {0, 1, 1};
  const auto result = compare_builds(request, cases(), {}, [](const std::string&) {});
  if (!result) RC_FAIL(result.error());
  RC_ASSERT(result->base.build.compiler == "base");
  RC_ASSERT(result->head.build.compiler == "head");
  const Judgement& judgement = result->judgement;
  RC_ASSERT(judgement.all.compared == jobs.size());
  RC_ASSERT(judgement.all.differing == differing);
  RC_ASSERT(judgement.findings.size() == differing);
  const double floor = std::log(1.01);
  Verdict worst = differing > 0 ? Verdict::kChanged : Verdict::kEquivalent;
  const auto check = [&](const Difference* row, double effect) {
    RC_ASSERT(row != nullptr);
    RC_LOG() << row->metric->name << ": " << row->effect << ", expected " << effect << '\n';
    RC_ASSERT(row->pairs.size() == request.pairs);
    RC_ASSERT(std::abs(row->effect - effect) < 1e-6);
    for (const double pair : row->pairs) RC_ASSERT(std::abs(pair - effect) < 1e-6);
    RC_ASSERT(row->noise < 1e-6);
    // All agree, so that the sign is certain: what is larger than the floor is told.
    const bool large = std::abs(effect) > row->floor;
    const Verdict expected =
        large ? (effect > 0 ? Verdict::kRegressed : Verdict::kImproved) : Verdict::kEquivalent;
    RC_ASSERT(row->verdict == expected);
    RC_ASSERT(row->fresh_pairs.size() == (large ? request.fresh_pairs : 0U));
    RC_ASSERT(row->confirmation.has_value() == large);
    if (expected == Verdict::kRegressed) worst = Verdict::kRegressed;
    if (expected == Verdict::kImproved) worst = std::max(worst, Verdict::kImproved);
  };
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const Difference* row = judgement.find(kProcessTime, cell);
    check(row, std::log(ratios[cell]));
    RC_ASSERT(std::abs(row->floor - floor) < 1e-6);
  }
  check(judgement.find(kProcessTime, std::nullopt), middle_mean(all));
  check(judgement.find(kProcessMemory, std::nullopt),
        std::log(static_cast<double>((4 << 20) + growth) / (4 << 20)));
  RC_ASSERT(judgement.all.verdict == worst);

  // As it is recorded.
  const db::GateRun run = gate_record(request, cases(), *result, any_flag());
  RC_ASSERT(run.compared == static_cast<std::int64_t>(jobs.size()));
  RC_ASSERT(run.differing == static_cast<std::int64_t>(differing));
  RC_ASSERT(run.base_build.compiler == "base");
  RC_ASSERT(run.build.compiler == "head");
  RC_ASSERT(run.verdict == (worst == Verdict::kRegressed ? "regressed" : "equivalent"));
  RC_ASSERT(run.cells.size() == cells.size() + 1);
  RC_ASSERT(run.differences.size() == differing);
  for (const db::GateCellRow& cell : run.cells) {
    std::size_t number = 0;
    while (cell.parameters && cells[number].row != *cell.parameters) ++number;
    const double slowdown = cell.parameters ? ratios[number] - 1 : std::exp(middle_mean(all)) - 1;
    RC_ASSERT(std::abs(cell.slowdown - slowdown) < 1e-6);
    RC_ASSERT(cell.pairs.size() == request.pairs);
    for (const double pair : cell.pairs) RC_ASSERT(std::abs(pair - slowdown) < 1e-6);
    RC_ASSERT(cell.verdict == (std::log(1 + slowdown) > cell.effect_floor ? "regressed" : "equivalent"));
    // What the gate calls improved the table tells by numbers, as its page says.
    const bool improved = cell.verdict == "equivalent" && cell.confirm_p_value.value_or(1) <= 0.05 &&
                          *cell.confirm_slowdown < std::exp(-cell.effect_floor) - 1;
    RC_ASSERT(improved == (std::log(1 + slowdown) < -cell.effect_floor));
  }
  RC_CLASSIFY(worst == Verdict::kRegressed, "slower");
  RC_CLASSIFY(differing > 0, "other plans");
}

// --- the worker ---------------------------------------------------------------------

std::vector<json> answers_to(const std::vector<json>& requests) {
  std::string text;
  for (const json& request : requests) text += request.dump() + "\n";
  std::istringstream in(text);
  std::ostringstream out;
  serve_gate(in, out);
  std::vector<json> lines;
  std::istringstream said(out.str());
  for (std::string line; std::getline(said, line);) lines.push_back(json::parse(line));
  return lines;
}

/// Each job as the planner itself plans it; what there is not is refused, and the worker goes on.
void workers_plan_what_they_are_asked_for() {
  const ScratchFolder folder;
  std::vector<json> requests;
  std::vector<Instance> instances;
  std::vector<std::pair<std::size_t, PlannerOptions>> jobs;
  for (auto left = any_whole(1, 2); left > 0; --left) {
    const PlanCase plan_case = *any_case();
    const std::filesystem::path file = folder.path() / (std::to_string(left) + ".xml");
    RC_ASSERT(!write_file(file.string(), write_instance_xml(plan_case.instance)).has_value());
    requests.push_back({{"load", file.string()}});
    instances.push_back(plan_case.instance);
    PlannerOptions options = plan_case.options;
    options.max_expansions = std::min<std::uint64_t>(options.max_expansions, 20'000);
    options.max_restarts = 5;
    options.time_limit_s = std::numeric_limits<double>::infinity();
    jobs.emplace_back(instances.size() - 1, options);
  }
  const std::size_t loaded = requests.size();
  for (const auto& [instance, options] : jobs)
    requests.push_back({{"instance", instance}, {"options", to_json(options)}});
  const std::size_t begun = requests.size();
  requests.push_back({{"plan", jobs.size()}});
  requests.push_back({{"instance", loaded}, {"options", json::object()}});
  requests.push_back({{"dance", 1}});
  requests.push_back({{"instance", 0}, {"options", json::object()}, {"task", "dance"}});
  for (std::size_t job = 0; job < jobs.size(); ++job) requests.push_back({{"plan", job}, {"check", true}});
  for (std::size_t job = 0; job < jobs.size(); ++job) requests.push_back({{"plan", job}, {"memory", true}});
  const std::vector<json> said = answers_to(requests);
  RC_ASSERT(said.size() == requests.size() + 1);  // after the greeting
  RC_ASSERT(greeting_from_json(said[0]).has_value());
  for (std::size_t i = 0; i < loaded; ++i) {
    if (said[i + 1].contains("error")) RC_DISCARD("a goal that cannot be reached");
    RC_ASSERT(said[i + 1].at("instance") == i);
    RC_ASSERT(said[i + 1].at("content_hash") == content_hash(instances[i]));
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) RC_ASSERT(said[loaded + i + 1].at("job") == i);
  for (std::size_t i = 0; i < 4; ++i) RC_ASSERT(said[begun + i + 1].contains("error"));
  for (std::size_t i = 0; i < 2 * jobs.size(); ++i) {
    const auto& [instance, options] = jobs[i % jobs.size()];
    const db::ResultRow expected = run_instance(instances[instance], options);
    const auto answer = answer_from_json(said[begun + 4 + i + 1]);
    RC_ASSERT(answer.has_value());
    RC_ASSERT(answer->row.status == expected.status);
    RC_ASSERT(answer->row.plan_hash == expected.plan_hash);
    RC_ASSERT(answer->row.makespan_s == expected.makespan_s);
    RC_ASSERT(answer->row.flowtime_s == expected.flowtime_s);
    RC_ASSERT(answer->row.tries == expected.tries);
    RC_ASSERT(answer->row.expansions == expected.expansions);
    RC_ASSERT(answer->row.generations == expected.generations);
    RC_ASSERT(answer->cpu_ns > 0);
    RC_ASSERT(answer->row.valid == (i < jobs.size() ? expected.valid : std::nullopt));
    RC_ASSERT(!answer->row.peak_memory_bytes.has_value() || i >= jobs.size());
  }
}

/// What calibrations left tells the noise, else the pairs themselves.
void noise_is_what_calibrations_measured() {
  GateRequest request;
  request.pairs = static_cast<std::size_t>(any_whole(4, 12));
  GateResult result;
  Difference row;
  row.metric = &kProcessTime;
  for (std::size_t i = 0; i < request.pairs; ++i)
    row.pairs.push_back(static_cast<double>(any_whole(-8, 8)) / 64);
  result.judgement.differences = {row, row};
  result.judgement.differences[1].cell = 0;
  std::vector<db::GateNoise> noise;
  std::vector<double> pairs;
  const auto comparisons = any_whole(0, 3);
  const bool of_cell = any_flag();
  if (comparisons > 0) {
    noise.emplace_back();
    if (of_cell) noise.back().parameters = cases().cells()[0].row;
    for (std::int64_t i = 0; i < comparisons; ++i) {
      noise.back().comparisons.emplace_back();
      for (int k = 0; k < 3; ++k) {
        noise.back().comparisons.back().push_back(static_cast<double>(any_whole(-8, 8)) / 64);
        pairs.push_back(std::log(1 + noise.back().comparisons.back().back()));
      }
    }
  }
  update_noise(request, cases(), noise, result);
  for (std::size_t i = 0; i < 2; ++i) {
    const Difference& told = result.judgement.differences[i];
    const bool known = comparisons > 0 && of_cell == (i == 1);
    const double error = standard_error(known ? pairs : row.pairs, request.pairs);
    RC_ASSERT(close(told.noise, error));
    RC_ASSERT(close(told.floor, std::max(std::log(1.01), 3 * error)));
    const GatePlan plan{request.pairs, request.fresh_pairs, 1};
    const double now = detectable(row.pairs, plan, told.floor);
    RC_ASSERT(told.detectable == (known ? std::max(now, detectable(pairs, plan, told.floor)) : now));
  }
}

const PropertyRoom room("gate", kCasesOfHistories, [] {
  bool passed = true;

  passed &=
      property("a comparison says what its workers said", comparisons_say_what_workers_said, kComparisons);
  passed &= property("a worker plans what it is asked for", workers_plan_what_they_are_asked_for, kFewer);
  passed &= property("noise is what calibrations measured, else the scatter of the pairs",
                     noise_is_what_calibrations_measured, kComparisons);

  return passed;
});

}  // namespace
}  // namespace sipplab::bench::gate_laws
