// The requests of a front end over a pipe, and their answers. docs/serve.md describes them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "src/runs/prepared_run.h"
#include "src/runs/run_monitor.h"

namespace needlework::serve {

using Json = nlohmann::ordered_json;

/// A request that is not understood (code 2).
struct RequestError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What requests need of the connection while they are answered.
struct Connection {
  std::function<bool()> interrupted;        ///< whether to stop the advance that is running
  std::function<void(const Json&)> notify;  ///< sends a line before the answer
};

/// The simulations of one front end. Used by one thread.
class Requests {
 public:
  /// Does what is asked for, and returns the answer without "id" and "ok". Throws RequestError,
  /// and what the simulation throws.
  Json answer(const Json& request, const Connection& connection);

 private:
  using Handler = Json (Requests::*)(const Json&, const Connection&);
  static const std::map<std::string, Handler> handlers;

  Json create(const Json& request, const Connection&);
  Json resume(const Json& request, const Connection&);
  Json checkpoint(const Json& request, const Connection&);
  Json advance(const Json& request, const Connection& connection);
  Json run_until(const Json& request, const Connection& connection);
  Json totals(const Json& request, const Connection&);
  Json state(const Json& request, const Connection&);
  Json velocities(const Json& request, const Connection&);
  Json sample(const Json& request, const Connection&);
  Json data(const Json& request, const Connection&);
  Json predict(const Json& request, const Connection&);
  Json close(const Json& request, const Connection&);
  Json version(const Json& request, const Connection&);

  runs::PreparedRun& run_of(const Json& request);
  Json add(std::unique_ptr<runs::PreparedRun> run, const std::string& warning);

  std::map<std::int64_t, std::unique_ptr<runs::PreparedRun>> runs_;
  std::int64_t next_ = 1;
};

}  // namespace needlework::serve
