#include "bench/gate/worker.hpp"

#include <filesystem>
#include <istream>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/gate/protocol.hpp"
#include "bench/gate/slowdown.hpp"
#include "bench/sweep/run_info.hpp"
#include "bench/sweep/run_instance.hpp"
#include "planner/solve/plan.hpp"
#include "sipplab/instance_io.hpp"

namespace sipplab::bench {
namespace {

using nlohmann::json;

struct Job {
  std::size_t instance = 0;
  PlannerOptions options;
};

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
    jobs_.push_back({instance, *options});
    return {{"job", jobs_.size() - 1}};
  }

  json plan_job(const json& request) {
    const auto number = request.at("plan").get<std::size_t>();
    if (number >= jobs_.size()) return error("no such job");
    const Job& job = jobs_[number];
    const Instance& instance = instances_[job.instance];
    WorkerAnswer answer;
    const std::int64_t begin_ns = thread_cpu_ns();
    const PlanResult result = plan(instance, job.options);
    burn(slowdown_, thread_cpu_ns() - begin_ns);
    answer.cpu_ns = thread_cpu_ns() - begin_ns;
    answer.row = request.value("check", false) ? judged(instance, job.options, result)
                                               : described(job.options, result);
    return to_json(answer);
  }

  std::vector<Instance> instances_;
  std::vector<Job> jobs_;
  double slowdown_ = injected_slowdown();
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
