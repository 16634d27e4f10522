// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/resources.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/result.h"
#include "tools/app/exit_status.h"
#include "tools/app/interruption.h"
#include "tools/app/printed_report.h"
#include "tools/app/progress_report.h"
#include "tools/batch/child_process.h"
#include "tools/batch/jobs.h"
#include "tools/batch/results_file.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// Result of a job.
struct Ended {
  ExitStatus status = ExitStatus::done;
  std::vector<std::string> messages;
  nlohmann::json stats;  ///< content of --stats; for `check` its report; null if there is none
  double seconds = 0;
};

CommandLine parse(const Job& job) {
  std::vector<std::string> words{"tetwright"};
  words.insert(words.end(), job.arguments.begin(), job.arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "--help" || words[i] == "-h" || words[i] == "--version")
      throw UsageError(words[i] + " is not a job; leave the line out");
    if (words[i] == "-" && words[i - 1] != "--stats")
      throw UsageError("a job cannot use standard input or output; give it files");
  }
  CommandLine line;
  (void)parse_command_line(static_cast<int>(argv.size()), argv.data(), line);
  if (line.command == Command::batch || line.command == Command::sample)
    throw UsageError(std::string(name_of(line.command)) +
                     " is not a job; jobs are prepare, mesh, simplify, improve, values, embed and check");
  if (!line.console.log_file.empty())
    throw UsageError("--log-file is for the whole batch; give it to batch itself");
  if (!line.input_format.empty() || line.outputs.mesh == "-" || line.outputs.boundary == "-")
    throw UsageError("a job cannot use standard input or output; give it files");
  if (line.outputs.stats == "-")
    throw UsageError("--stats - is for single runs; the results have the statistics");
  return line;
}

/// Rejects jobs that write the same file, a file of the batch, or a file that another job reads: the order of
/// jobs is undefined.
void check_jobs_are_independent(const CommandLine& batch, const std::vector<Job>& jobs) {
  const std::string& file = batch.inputs.front();
  std::map<std::string, std::string> written;  // file, and the job that writes it
  std::vector<std::pair<std::string, std::string>> read;
  for (const Job& job : jobs) {
    CommandLine line;
    try {
      line = parse(job);
    } catch (const UsageError&) {
      continue;  // the job's result will report the error
    }
    for (const std::string& path : written_files(line)) {
      for (const std::string& of_batch : {file, results_file_of(batch), batch.console.log_file})
        if (!of_batch.empty() && real_path(path) == real_path(of_batch))
          throw InputError(
              file, 0,
              "job '" + job.id + "' writes " + path + ", which is a file of the batch; give it another name");
      const auto [first, added] = written.emplace(real_path(path), job.id);
      if (!added)
        throw InputError(file, 0,
                         "job '" + job.id + "' writes " + path + ", as job '" + first->second +
                             "' does; give each its own");
    }
    for (const std::string& path : read_files(line)) read.emplace_back(real_path(path), job.id);
  }
  for (const auto& [path, id] : read) {
    const auto writer = written.find(path);
    if (writer == written.end() || writer->second == id) continue;
    std::string message = "job '";
    message.append(id).append("' reads ").append(path).append(", which job '").append(writer->second);
    throw InputError(file, 0,
                     message + "' writes; jobs run in no particular order: put it into a separate batch");
  }
}

void carry_out(CommandRun& run, Ended& ended) {
  if (run.line.command == Command::check) {
    const CheckReport check = make_check(run);
    ended.stats = nlohmann::json::parse(check_json(run, check));
  } else if (run.line.command == Command::embed) {
    check_output_paths(run.line);
    write_embedding(make_embedding(run), run);
    ended.stats = nlohmann::json::parse(stats_json(run));
  } else {
    check_output_paths(run.line);
    Prepared result = make_result(run);
    write_result(result, run);
    ended.stats = nlohmann::json::parse(stats_json(run));
  }
  ended.messages = notes_of(run.report);
  for (std::string& line : shortfalls_of(run.report)) ended.messages.push_back(std::move(line));
  ended.status = run.status;
}

/// Runs one job. Exceptions become its status, so that other jobs continue.
///
/// \param memory limit, bytes
Ended run_job(const Job& job, unsigned threads, double memory) {
  const Stopwatch watch;
  Ended ended;
  try {
    CommandLine line = parse(job);
    if (line.options.limits.threads == 0) line.options.limits.threads = threads;
    check_stats_path(line);
    ProgressReport progress(ProgressStyle::none, true);  // keeps the stage for messages and the log
    with_threads(line.options.limits.threads, [&] {
      const MemoryLimit share(memory);
      CommandRun run(line, progress);
      try {
        carry_out(run, ended);
      } catch (const std::exception& e) {
        report_failure(e, run);
        throw;
      }
    });
  } catch (const std::bad_alloc&) {
    ended.status = ExitStatus::output_failed;
    ended.messages = {"not enough memory; free some, give fewer --jobs, or ask for larger cells"};
  } catch (const std::exception& e) {
    ended.status = exit_status(e);
    ended.messages = {failure_message(e)};
  }
  ended.seconds = watch.seconds();
  return ended;
}

std::string result_line(const Job& job, const Ended& ended) {
  // Messages may contain bytes of names that are not UTF-8; they are replaced.
  return nlohmann::json{{"id", job.id},
                        {"args", job.arguments},
                        {"status", static_cast<int>(ended.status)},
                        {"seconds", ended.seconds},
                        {"messages", ended.messages},
                        {"stats", ended.stats}}
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Whether another attempt may succeed: after an output error, a time limit, an internal error or an
/// interruption.
bool worth_another_attempt(int status) {
  return status == static_cast<int>(ExitStatus::output_failed) ||
         status == static_cast<int>(ExitStatus::internal_error) ||
         status == static_cast<int>(ExitStatus::interrupted);
}

std::vector<const Job*> unfinished_jobs(const std::vector<Job>& jobs, const ResultsFile& results,
                                        bool retry) {
  std::vector<const Job*> left;
  for (const Job& job : jobs) {
    const int status = results.status_of(job);
    const bool finished = retry ? status == 0 : status >= 0 && !worth_another_attempt(status);
    if (!finished) left.push_back(&job);
  }
  return left;
}

/// Text such as "was killed by signal 11 (Segmentation fault)".
std::string death_text(const ProcessEnd& end) {
  if (end.signal == 0) return "ended with status " + std::to_string(end.status);
  return "was killed by signal " + std::to_string(end.signal) + " (" + strsignal(end.signal) + ")";
}

/// Result of a job whose process died.
Ended ended_by(const ProcessEnd& end, double seconds) {
  Ended ended;
  ended.seconds = seconds;
  const std::string what = "its process " + death_text(end);
  if (end.signal == 0) {
    ended.status = static_cast<ExitStatus>(end.status);
    ended.messages = {what + ", with the reason on stderr"};
  } else if (end.signal == SIGKILL || end.signal == SIGXCPU) {
    ended.status = ExitStatus::output_failed;
    ended.messages = {what +
                      (end.signal == SIGKILL
                           ? ", as happens when memory runs out; free some, give fewer --jobs, or "
                           : ", its CPU time limit; raise it, or ") +
                      "ask for larger cells"};
  } else {
    ended.status = ExitStatus::internal_error;
    ended.messages = {what + report_this};
  }
  return ended;
}

/// Appends the results of jobs to the file and prints them.
class Recorder {
 public:
  Recorder(const std::vector<const Job*>& jobs, JobStates& states, ResultsFile& results, CommandRun& run)
      : jobs_(jobs), states_(states), results_(results), run_(run) {}

  /// May be called concurrently.
  ///
  /// \throws OutputError if the result cannot be written
  void record(std::size_t job, const Ended& ended) {
    const std::lock_guard lock(mutex_);
    states_.set(job, JobState::recorded);
    results_.append(*jobs_[job], static_cast<int>(ended.status), result_line(*jobs_[job], ended));
    states_.set(job, JobState::ended);
    tell(*jobs_[job], ended);
  }

 private:
  void tell(const Job& job, const Ended& ended) {
    run_.progress.finish();  // clears the bar
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, ": status %d, %.2f s", static_cast<int>(ended.status),
                  ended.seconds);
    if (ended.status != ExitStatus::done || !run_.line.console.quiet) {
      print_line(
          "job '" + job.id + "'" + numbers +
          (ended.status == ExitStatus::done || ended.messages.empty() ? "" : "; " + ended.messages.back()));
    }
    std::size_t all_ended = 0;
    for (std::size_t j = 0; j < states_.size(); ++j) all_ended += states_[j] == JobState::ended;
    run_.progress.update(static_cast<double>(all_ended) / static_cast<double>(states_.size()));
  }

  const std::vector<const Job*>& jobs_;
  JobStates& states_;
  ResultsFile& results_;
  CommandRun& run_;
  std::mutex mutex_;  // guards everything in record()
};

/// Runs jobs concurrently.
class Batch {
 public:
  Batch(const std::vector<const Job*>& jobs, JobStates& states, Recorder& recorder)
      : jobs_(jobs), states_(states), recorder_(recorder) {}

  /// Runs the jobs of the list, at most `at_once` at a time.
  void carry_out(const std::vector<std::size_t>& list, std::size_t at_once) {
    const unsigned all = thread_count();
    const auto workers = static_cast<unsigned>(std::min(at_once, list.size()));
    if (workers == 0) return;
    // Memory is divided among the workers: a job does not know of the others.
    const double memory = available_memory() / workers;
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> threads;
    const unsigned each = std::max(1u, all / workers);
    threads.reserve(workers);
    try {
      for (unsigned w = 0; w < workers; ++w) threads.emplace_back([&] { work(list, next, each, memory); });
    } catch (const std::exception& e) {
      // The threads that were started run all jobs.
      if (threads.empty())
        throw OutputError(std::string("cannot start a thread: ") + e.what() +
                          "; free some memory or processes");
    }
    for (std::thread& t : threads) t.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void work(const std::vector<std::size_t>& list, std::atomic<std::size_t>& next, unsigned threads,
            double memory) {
    for (std::size_t i; !stop_ && (i = next++) < list.size();) {
      states_.begin(list[i]);
      const Ended ended = run_job(*jobs_[list[i]], threads, memory);
      try {
        recorder_.record(list[i], ended);
      } catch (...) {
        // Stop, since the results of further jobs would be lost.
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        stop_ = true;
        return;
      }
    }
  }

  const std::vector<const Job*>& jobs_;
  JobStates& states_;
  Recorder& recorder_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;  // guards the failure
  std::exception_ptr failure_;
};

/// Removes the temporary files that a dead process left next to a job's outputs.
void remove_temporary_files_of(const Job& job, int process) {
  try {
    for (const std::string& path : written_files(parse(job))) remove_temporary_files(path, process);
  } catch (const UsageError&) {
    // The job has written nothing.
  }
}

std::vector<std::size_t> jobs_that_are(JobState state, const JobStates& states) {
  std::vector<std::size_t> found;
  for (std::size_t j = 0; j < states.size(); ++j)
    if (states[j] == state) found.push_back(j);
  return found;
}

/// Runs all waiting jobs in a child process. Suspects, which were running when a child died, run first, one
/// at a time.
void carry_out_waiting(const std::vector<const Job*>& jobs, JobStates& states,
                       const std::vector<std::size_t>& suspects, Recorder& recorder, CommandRun& run) {
  Batch batch(jobs, states, recorder);
  batch.carry_out(suspects, 1);
  batch.carry_out(jobs_that_are(JobState::waiting, states),
                  run.line.batch.jobs > 0 ? run.line.batch.jobs : thread_count());
  run.progress.finish();
}

}  // namespace

void run_batch(CommandRun& run) {
  const CommandLine& line = run.line;
  const std::vector<Job> jobs = read_jobs(line.inputs.front());
  check_jobs_are_independent(line, jobs);
  ResultsFile results(results_file_of(line));
  say_when_interrupted("tetwright: interrupted; repeat the call to run the remaining jobs\n");
  const std::vector<const Job*> left = unfinished_jobs(jobs, results, line.batch.retry);
  JobStates states(left.size());
  Recorder recorder(left, states, results, run);
  std::vector<std::size_t> suspects;
  if (!left.empty()) run.progress.begin_stage("jobs");
  for (;;) {
    const ProcessEnd end = run_in_child_process([&] {
      try {
        carry_out_waiting(left, states, suspects, recorder, run);
        return 0;
      } catch (const std::exception& e) {
        run.progress.finish();
        print_line(failure_message(e));
        return static_cast<int>(exit_status(e));
      }
    });
    results.reload();
    const std::vector<std::size_t> running = jobs_that_are(JobState::running, states),
                                   recorded = jobs_that_are(JobState::recorded, states);
    // A process that ends with an error during a job, for example because no thread can be started, counts as
    // killed by that job.
    const bool interrupted = end.status == static_cast<int>(ExitStatus::interrupted);
    if (end.signal == 0 && (running.empty() || interrupted)) {
      run.status = static_cast<ExitStatus>(end.status);
      break;
    }
    for (const std::vector<std::size_t>& jobs_then : {running, recorded})
      for (const std::size_t job : jobs_then) remove_temporary_files_of(*left[job], end.id);
    if (running.empty() && recorded.empty())
      throw OutputError("the process of the batch " + death_text(end) +
                        " between jobs; repeat the call to run the remaining jobs");
    std::vector<std::size_t> next;
    if (running.size() == 1 && recorded.empty()) {
      recorder.record(running[0], ended_by(end, states.seconds(running[0])));
    } else {
      next = running;
      next.insert(next.end(), recorded.begin(), recorded.end());
    }
    for (const std::size_t job : next) states.set(job, JobState::waiting);
    // Keep earlier suspects that have not run yet.
    for (const std::size_t job : suspects)
      if (states[job] == JobState::waiting && std::find(next.begin(), next.end(), job) == next.end())
        next.push_back(job);
    suspects = std::move(next);
  }
  if (run.status != ExitStatus::done) return;
  const auto done = static_cast<std::size_t>(
      std::count_if(jobs.begin(), jobs.end(), [&](const Job& job) { return results.status_of(job) == 0; }));
  if (done < jobs.size()) {
    run.status = ExitStatus::short_of_request;
    print_line(std::to_string(jobs.size() - done) + " of " + std::to_string(jobs.size()) +
               " jobs did not end with status 0; " + results_file_of(line) + " says why");
  }
}

}  // namespace tetwright
