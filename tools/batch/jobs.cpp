// SPDX-License-Identifier: Apache-2.0
#include "tools/batch/jobs.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/io/names/mesh_fields.h"
#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

/// Formats a number as an argument: 1e3 becomes 1000, as options with whole numbers require.
std::string number_text(const nlohmann::json& number) {
  if (!number.is_number_float()) return number.dump();
  const auto value = number.get<double>();
  return value == std::floor(value) && std::fabs(value) <= max_exact_whole
             ? std::to_string(static_cast<std::int64_t>(value))
             : number.dump();
}

Job parse_job(const std::string& file, std::size_t line, const std::string& text) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(file, line,
                     what + R"(; a job is a line such as {"id": "a", "args": ["prepare", "a.ply", "-o", )"
                            R"("a.vtu", "--target-tets", "10000"]})");
  };
  Job job;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    if (!json.is_object()) refuse("it is not a JSON object");
    for (const auto& [key, value] : json.items())
      if (key != "id" && key != "args") refuse("unknown key '" + key + "'");
    if (!json.contains("args") || !json["args"].is_array() || json["args"].empty())
      refuse("\"args\" is not a list of arguments");
    for (const nlohmann::json& argument : json["args"]) {
      // Numbers are accepted, so that scripts need not convert them to text.
      if (argument.is_string())
        job.arguments.push_back(argument.get<std::string>());
      else if (argument.is_number())
        job.arguments.push_back(number_text(argument));
      else
        refuse("argument " + std::to_string(job.arguments.size() + 1) + " is neither text nor a number");
      if (job.arguments.back().find('\0') != std::string::npos)
        refuse("argument " + std::to_string(job.arguments.size()) + " has a NUL in it");
    }
    job.id = std::to_string(line);
    if (const auto id = json.find("id"); id != json.end()) {
      if (!id->is_string() && !id->is_number()) refuse("\"id\" is neither text nor a number");
      job.id = id->is_string() ? id->get<std::string>() : id->dump();
    }
  } catch (const nlohmann::json::out_of_range&) {
    refuse("a number in it is too large");
  } catch (const nlohmann::json::exception& e) {
    const std::string what = e.what();  // "[json.exception...] parse error at line 1, column 7: ..."
    const std::size_t from = what.find("column");
    refuse("it is not JSON (" + (from == std::string::npos ? what : what.substr(from)) + ")");
  }
  return job;
}

}  // namespace

std::vector<Job> read_jobs(const std::string& file) {
  std::vector<Job> jobs;
  std::map<std::string, std::size_t> lines;
  std::istringstream in(read_whole_file(file));
  std::size_t number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    jobs.push_back(parse_job(file, number, text));
    const auto [first, added] = lines.emplace(jobs.back().id, number);
    if (!added)
      throw InputError(file, number,
                       "the id '" + jobs.back().id + "' is that of line " + std::to_string(first->second) +
                           ", too; give each job its own");
  }
  if (jobs.empty()) throw InputError(file, 0, "it has no jobs; give one per line");
  return jobs;
}

}  // namespace tetwright
