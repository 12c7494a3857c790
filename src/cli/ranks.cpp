// The only file that uses MPI: its C interface, as far as a sweep needs it.
#include "src/cli/ranks.h"

#ifdef NEEDLEWORK_MPI
#include <mpi.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <initializer_list>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/cli/messages.h"
#include "src/runs/failure.h"

namespace needlework::cli {

using enum runs::ExitCode;
namespace {

// Environment variables that Open MPI and other launchers set for their processes.
constexpr const char* marks[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "PMI_RANK"};

bool launched() {
  return std::any_of(std::begin(marks), std::end(marks),
                     [](const char* mark) { return std::getenv(mark) != nullptr; });
}

// The first of these variables that is set, as a number.
int number_from(std::initializer_list<const char*> variables, int otherwise) {
  for (const char* variable : variables) {
    if (const char* value = std::getenv(variable)) return std::atoi(value);
  }
  return otherwise;
}

}  // namespace

Launch mpi_launch() {
  if (!launched()) return {};
  return {number_from({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}, 0),
          number_from({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}, 1)};
}

#ifdef NEEDLEWORK_MPI

Ranks::Ranks() {
  if (!launched()) return;
  int offered = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &offered);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  // Open MPI advises against forks: with some networks they corrupt what is being sent.
  if (count_ > 1) io::set_reads_in_child_process(false);
}

Ranks::~Ranks() {
  int initialised = 0;
  MPI_Initialized(&initialised);
  if (initialised) MPI_Finalize();
}

std::vector<int> Ranks::greatest(std::vector<int> values) const {
  if (count_ == 1) return values;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT, MPI_MAX,
                MPI_COMM_WORLD);
  return values;
}

#else

Ranks::Ranks() {
  if (mpi_launch().count > 1) {
    throw InputError("several MPI ranks: expected a program built with MPI, or --member K/M");
  }
}

Ranks::~Ranks() = default;

std::vector<int> Ranks::greatest(std::vector<int> values) const { return values; }

#endif

int Ranks::do_everywhere(const std::function<void()>& action) const {
  runs::Failure failure{ok, {}};
  try {
    action();
  } catch (const std::exception&) {
    failure = runs::current_failure();
  }
  std::vector<int> codes(count_, ok);
  codes[rank_] = failure.exit_code;
  codes = greatest(codes);
  const auto first = std::find_if(codes.begin(), codes.end(), [](int code) { return code != ok; });
  if (first == codes.end()) return ok;
  if (first - codes.begin() == rank_) print_error(failure.message);
  return *first;
}

}  // namespace needlework::cli
