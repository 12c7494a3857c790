#include "src/cli/signals.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <ctime>

namespace needlework::cli {
namespace {

// A signal handler can reach nothing but globals.
std::atomic<Simulation*> interrupted_by_signals = nullptr;
std::atomic<int> signal_received = 0;
std::atomic<std::int64_t> received_at = 0;  // of the first that is no warning [ns]
static_assert(std::atomic<Simulation*>::is_always_lock_free);
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

// Batch systems send the last three some time before they end a job: SIGXCPU once a second, and the
// others may be followed by SIGTERM.
constexpr std::array handled{SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};

bool is_warning(int signal) { return signal == SIGUSR1 || signal == SIGUSR2 || signal == SIGXCPU; }

std::array<struct sigaction, handled.size()> before;  // of the guard

std::int64_t nanoseconds() {
  std::timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1000000000} + now.tv_nsec;
}

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

// All of it may be done in a signal handler.
void handle(int signal) {
  if (signal_received == 0) signal_received = signal;
  if (!is_warning(signal)) {
    if (received_at == 0) {
      received_at = nanoseconds();
    } else if (nanoseconds() - received_at > 200000000) {
      set_handler(signal, SIG_DFL);
      raise(signal);
    }
  }
  if (Simulation* simulation = interrupted_by_signals) simulation->interrupt();
}

}  // namespace

void SignalGuard::interrupt(Simulation& simulation) {
  interrupted_by_signals = &simulation;
  if (signal_received != 0) simulation.interrupt();
}

SignalGuard::SignalGuard() {
  signal_received = 0;
  received_at = 0;
  for (std::size_t n = 0; n < handled.size(); ++n) {
    sigaction(handled[n], nullptr, &before[n]);
    // `nohup` has a program go on when its terminal is closed, and what starts a job may want no
    // warnings. (Shells have background jobs ignore SIGINT in the same way, but who sends it to
    // such a job by `kill` means it.)
    const bool may_be_unwanted = handled[n] == SIGHUP || is_warning(handled[n]);
    const bool unwanted = may_be_unwanted && before[n].sa_handler == SIG_IGN;
    if (!unwanted) set_handler(handled[n], handle);
  }
}

SignalGuard::~SignalGuard() {
  for (std::size_t n = 0; n < handled.size(); ++n) sigaction(handled[n], &before[n], nullptr);
  interrupted_by_signals = nullptr;
}

int SignalGuard::received() { return signal_received; }

}  // namespace needlework::cli
