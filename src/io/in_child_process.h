// Objects that live in a child process and are used by their members: what reads untrusted files.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <type_traits>
#include <utility>

#include "src/archive/archive.h"
#include "src/io/hdf5.h"
#include "src/io/reader_process.h"

namespace needlework::io {

/// An object that reads the file `path`, made and kept in a child process (see ReaderProcess); in
/// this one if reads_in_child_process() is false. Arguments and results of its members go through
/// an Archive. Each call is a session of HDF5.
template <class Object>
class InChildProcess {
 public:
  /// `make` returns a std::unique_ptr<Object>. Throws what it throws, and what ReaderProcess
  /// throws.
  template <class Make>
  InChildProcess(const std::string& path, Make make) {
    if (!reads_in_child_process()) {
      const hdf5::Session session;
      here_ = make();
      return;
    }
    std::error_code ignored;
    const auto bytes = std::filesystem::file_size(path, ignored);
    process_.emplace(path, limits_for(ignored ? 0 : bytes), [&]() -> ReaderProcess::Service {
      const hdf5::Session session;
      // Never destroyed: the process ends without running destructors.
      Object* const object = make().release();
      return [object](std::string_view request) { return answer(*object, request); };
    });
  }
  ~InChildProcess() {
    const hdf5::Session session;
    here_.reset();
  }

  /// Calls `member`, a pointer to a member function of Object.
  template <auto member, class... Arguments>
  auto call(Arguments... arguments) const {
    using Result = std::decay_t<std::invoke_result_t<decltype(member), Object&, Arguments...>>;
    if (here_) {
      const hdf5::Session session;
      return Result(std::invoke(member, *here_, arguments...));
    }
    // The child is a fork: its functions have the same addresses.
    const Function function = &invoke<member, Arguments...>;
    auto address = reinterpret_cast<std::uintptr_t>(function);
    std::string request;
    Archive out = Archive::to(request);
    out(address, arguments...);
    const std::string bytes = process_->ask(request);
    Result result{};
    Archive in = Archive::from(bytes);
    in(result);
    return result;
  }

 private:
  using Function = std::string (*)(Object&, Archive&);

  static std::string answer(Object& object, std::string_view request) {
    const hdf5::Session session;
    Archive in = Archive::from(request);
    std::uintptr_t address = 0;
    in(address);
    return reinterpret_cast<Function>(address)(object, in);
  }

  template <auto member, class... Arguments>
  static std::string invoke(Object& object, Archive& in) {
    std::tuple<Arguments...> arguments{};
    std::apply([&](auto&... each) { in(each...); }, arguments);
    auto result =
        std::apply([&](auto&... each) { return std::invoke(member, object, each...); }, arguments);
    std::string bytes;
    Archive out = Archive::to(bytes);
    out(result);
    return bytes;
  }

  std::unique_ptr<Object> here_;
  mutable std::optional<ReaderProcess> process_;
};

/// The result of `read()`, which reads the file `path`, called as a member of InChildProcess is.
template <class Read>
auto read_in_child_process(const std::string& path, Read read) {
  struct Once {
    Read read;
    auto get() { return read(); }
  };
  const InChildProcess<Once> once(path, [&] { return std::make_unique<Once>(Once{read}); });
  return once.template call<&Once::get>();
}

}  // namespace needlework::io
