#include "tools/app/log_file.h"

#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>

#include <memory>

#include "common/error.h"
#include "common/message_text.h"

namespace tetwright {

namespace {

std::shared_ptr<spdlog::logger> logger;

}  // namespace

void open_log(const std::string& path) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path);
    sink->set_formatter(std::make_unique<spdlog::pattern_formatter>("%Y-%m-%dT%H:%M:%S.%eZ %P %v",
                                                                    spdlog::pattern_time_type::utc));
    logger = std::make_shared<spdlog::logger>("tetwright", std::move(sink));
    logger->flush_on(spdlog::level::trace);
  } catch (const spdlog::spdlog_ex& e) {
    throw OutputError("--log-file " + path + ": " + e.what() +
                      "; give a file in a folder that can be written");
  }
}

void log_line(const std::string& text) {
  if (logger) logger->info(printable(text));
}

}  // namespace tetwright
