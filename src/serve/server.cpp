#include "src/serve/server.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <istream>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>

#include "needlework/error.h"
#include "src/json/shallow_json.h"
#include "src/runs/failure.h"
#include "src/serve/requests.h"

namespace needlework::serve {

using json::parse_shallow;
namespace {

Json error_of(const runs::Failure& failure) {
  return {{"ok", false}, {"code", failure.exit_code}, {"message", failure.message}};
}

/// That of the exception being handled.
runs::Failure failure_now() {
  try {
    throw;
  } catch (const RequestError& error) {
    return {runs::bad_usage, error.what()};
  } catch (...) {
    return runs::current_failure();
  }
}

/// A line of the input.
struct Line {
  std::uint64_t number = 0;
  Json request;
  std::string misunderstood;  ///< why the line is no request; empty if it is one

  bool asks_for(const char* what) const { return request.value("do", Json()) == what; }
};

Line parse(std::uint64_t number, const std::string& text) {
  Line line{.number = number, .request = Json::object(), .misunderstood = {}};
  const std::string place = "line " + std::to_string(number) + ": ";
  try {
    Json parsed = parse_shallow<Json>(text);
    if (!parsed.is_object()) throw RequestError("expected a JSON object");
    line.request = std::move(parsed);
  } catch (const Json::parse_error& error) {
    line.misunderstood =
        place + "no JSON at byte " + std::to_string(error.byte) + ": expected a JSON object";
  } catch (const Json::exception&) {
    line.misunderstood = place + "expected numbers that a double can hold";
  } catch (const std::runtime_error& error) {  // InputError, RequestError
    line.misunderstood = place + error.what();
  }
  return line;
}

class Server {
 public:
  explicit Server(std::ostream& out) : out_(out), worker_([this] { work(); }) {}
  ~Server() {
    push(std::nullopt);
    worker_.join();
  }

  /// Takes a line of input; false after "quit".
  bool take(const std::string& text) {
    ++line_;
    Line line = parse(line_, text);
    const bool quits = line.asks_for("quit");
    // All that was sent before is meant, also what has not begun.
    if (quits || line.asks_for("interrupt")) interrupted_ = line_;
    push(std::move(line));
    return !quits && !broken_;
  }

  bool broken() const { return broken_; }

 private:
  void push(std::optional<Line> line) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(std::move(line));
    }
    arrived_.notify_one();
  }

  std::optional<Line> next() {
    std::unique_lock lock(mutex_);
    arrived_.wait(lock, [&] { return !waiting_.empty(); });
    std::optional<Line> line = std::move(waiting_.front());
    waiting_.pop_front();
    return line;
  }

  void work() {
    Requests requests;
    while (const std::optional<Line> line = next()) {
      const Connection connection{
          .interrupted = [&] { return broken_ || interrupted_ > line->number; },
          .notify = [&](const Json& progress) { send(progress); }};
      send(answer(requests, *line, connection));
    }
  }

  static Json answer(Requests& requests, const Line& line, const Connection& connection) {
    Json answer;
    if (line.request.contains("id")) answer["id"] = line.request["id"];
    try {
      if (!line.misunderstood.empty()) throw RequestError(line.misunderstood);
      const bool done = line.asks_for("interrupt") || line.asks_for("quit");
      const Json result = done ? Json::object() : requests.answer(line.request, connection);
      answer["ok"] = true;
      answer.update(result);
    } catch (...) {
      answer.update(error_of(failure_now()));
    }
    return answer;
  }

  void send(const Json& message) {
    out_ << message.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
    if (!out_) broken_ = true;
  }

  std::ostream& out_;
  std::uint64_t line_ = 0;
  std::atomic<std::uint64_t> interrupted_ = 0;  ///< the last line that interrupts
  std::atomic<bool> broken_ = false;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<std::optional<Line>> waiting_;  ///< empty: the end
  std::thread worker_;
};

}  // namespace

void serve(std::istream& in, std::ostream& out) {
  bool broken = false;
  {
    Server server(out);
    std::string line;
    while (std::getline(in, line) && server.take(line)) {
    }
    broken = server.broken();
  }
  if (broken || !out) throw IoError("standard output: cannot be written");
}

}  // namespace needlework::serve
