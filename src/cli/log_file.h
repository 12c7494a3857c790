// A log in JSON Lines: one object a line.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace needlework::cli {

/// Appends to a file, each line by one write under a lock, so that several processes can share it
/// and a line is whole whenever the process ends.
class LogFile {
 public:
  /// Opens the file or makes it. Throws IoError, "PLACE: reason", if it cannot be written, or if it
  /// holds something else than a log.
  LogFile(const std::string& path, std::string place);
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  /// Appends an object: "event", its name, and "at", the present in UTC, before the given keys.
  /// What cannot be written, to a full disk say, is left out with one warning on stderr: a run is
  /// worth more than its log.
  void write(std::string_view event, const nlohmann::ordered_json& keys);

 private:
  std::string place_;
  int descriptor_;
  bool has_warned_ = false;
};

}  // namespace needlework::cli
