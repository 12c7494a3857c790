#include "src/engine/loops/loops.h"
#include "src/engine/loops/with_model.h"
#include "src/engine/parallel_loop.h"

namespace needlework {

std::unique_ptr<Loop> make_parallel_loop(Run& run, NearSearch search, ReplacedRecords replaced,
                                         int threads, const ParallelTuning& tuning) {
  return with_model(run.effects, [&]<Model M>() -> std::unique_ptr<Loop> {
    return std::make_unique<ParallelLoop<NearSearch, M>>(run, std::move(search),
                                                         std::move(replaced), threads, tuning);
  });
}

}  // namespace needlework
