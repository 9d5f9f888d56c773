#include "bench/gate/worker.hpp"

#include <cstdlib>
#include <deque>
#include <filesystem>
#include <istream>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/gate/laboratory.hpp"
#include "bench/gate/protocol.hpp"
#include "bench/gate/slowdown.hpp"
#include "bench/sweep/peak_memory.hpp"
#include "bench/sweep/run_info.hpp"
#include "bench/sweep/run_instance.hpp"
#include "sipplab/instance_io.hpp"
#include "sipplab/solve.hpp"

namespace sipplab::bench {
namespace {

using nlohmann::json;

struct Job {
  std::size_t instance = 0;
  PlannerOptions options;
  GateTask task = GateTask::kPlan;
};

/// Into which task the slowdown goes.
GateTask slowed_task() {
  const char* value = std::getenv(kIntoVariable);
  return parse_gate_task(value == nullptr ? "" : value).value_or(GateTask::kPlan);
}

class Worker {
 public:
  json answer(const json& request) {
    if (!request.is_object()) return error("not a request");
    try {
      if (request.contains("load")) return load(request.at("load").get<std::string>());
      if (request.contains("options")) return add_job(request);
      if (request.contains("plan")) return plan_job(request);
    } catch (const json::exception& broken) {
      return error(broken.what());
    }
    return error("an unknown request");
  }

 private:
  static json error(const std::string& what) { return {{"error", what}}; }

  json load(const std::string& file) {
    InstanceFiles files;
    files.instance = file;
    Input<LoadedInstance> loaded = load_instance(files);
    if (!loaded) return error(loaded.error().message());
    instances_.push_back(std::move(loaded->instance));
    files_.push_back(file);
    if (!laboratory_) laboratory_.emplace(std::filesystem::path(file).parent_path());
    return {{"instance", instances_.size() - 1}, {"content_hash", content_hash(instances_.back())}};
  }

  json add_job(const json& request) {
    const auto instance = request.at("instance").get<std::size_t>();
    Expected<PlannerOptions, std::string> options = options_from_json(request.at("options"));
    if (!options) return error(options.error());
    if (instance >= instances_.size()) return error("no such instance");
    if (changed_ == instance) {
      const bool shortest = options->order == InitialOrder::kShortestFirst;
      options->order = shortest ? InitialOrder::kLongestFirst : InitialOrder::kShortestFirst;
    }
    const auto task = parse_gate_task(request.value("task", "plan"));
    if (!task) return error("no such task");
    jobs_.push_back({instance, *options, *task});
    return {{"job", jobs_.size() - 1}};
  }

  json plan_job(const json& request) {
    const auto number = request.at("plan").get<std::size_t>();
    if (number >= jobs_.size()) return error("no such job");
    const Job& job = jobs_[number];
    const Instance& instance = instances_[job.instance];
    if (job.task != GateTask::kPlan) return do_task(job);
    WorkerAnswer answer;
    const bool check = request.value("check", false);
    std::optional<PeakMemory> memory;
    if (request.value("memory", false)) memory.emplace();
    const std::int64_t begin_ns = thread_cpu_ns();
    const SolveResult solved = solve(instance, job.options);
    burn(slowed_ == GateTask::kPlan ? slowdown_ : 0, thread_cpu_ns() - begin_ns);
    answer.cpu_ns = thread_cpu_ns() - begin_ns;
    std::optional<std::int64_t> bytes;
    if (memory) bytes = memory->bytes();
    answer.row = described(job.options, solved);
    answer.row.peak_memory_bytes = bytes;
    if (check && solved.is_solved()) {
      add_verdict(instance, solved.solution(), solved.guarantees(job.options.rules), answer.row);
    }
    return to_json(answer);
  }

  json do_task(const Job& job) {
    const auto timed = laboratory_->run(job.task, files_[job.instance], instances_[job.instance], job.options,
                                        slowed_ == job.task ? slowdown_ : 0);
    if (!timed) return error(timed.error());
    WorkerAnswer answer;
    answer.row.status = db::ResultStatus::kSolved;
    answer.row.plan_hash = timed->outcome;
    answer.cpu_ns = timed->cpu_ns;
    return to_json(answer);
  }

  std::deque<Instance> instances_;  ///< which the laboratory knows by their place
  std::vector<std::string> files_;
  std::optional<Laboratory> laboratory_;
  std::vector<Job> jobs_;
  double slowdown_ = injected_slowdown();
  GateTask slowed_ = slowed_task();
  std::optional<std::size_t> changed_ = injected_change();
};

WorkerGreeting greeting() {
  WorkerGreeting words;
  words.build = build_info(source_info());
  std::error_code error;
  words.program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  words.unfit = unfit_for_timing();
  words.injected_slowdown = injected_slowdown();
  return words;
}

void say(std::ostream& answers, const json& line) {
  answers << line.dump(-1, ' ', false, json::error_handler_t::replace) << '\n' << std::flush;
}

}  // namespace

void serve_gate(std::istream& requests, std::ostream& answers) {
  say(answers, to_json(greeting()));
  Worker worker;
  for (std::string line; std::getline(requests, line);) {
    say(answers, worker.answer(json::parse(line, nullptr, false)));
  }
}

}  // namespace sipplab::bench
