# Tests of GoogleTest with the label long, beside their other labels: ctest reads this list. They repeat
# at length, on more seeds or on every instruction set, what shorter tests of ./test.sh check, which the
# comments name. .ci/run runs them.
set_tests_properties(
  # OneTrajectory.OfThreads
  OneTrajectory.OfThreadsOnEveryInstructionSet
  # Continuing.AKillAtAnyMomentLosesNothing, Continuing.AFullDiskLosesNothing
  Continuing.AKillInAnyWriteLosesNothing
  Continuing.AKillWhileRowsAreRemovedLosesNothing
  Failing.AnyWriteMayFindTheDiskFull
  # the first of these seeds
  Seeds/Borders.AreDecidedToTheLastBit/1
  Seeds/Borders.AreDecidedToTheLastBit/2
  Seeds/Borders.AreDecidedToTheLastBit/3
  Seeds/Borders.AreDecidedToTheLastBit/4
  Seeds/Borders.AreDecidedToTheLastBit/5
  Seeds/Borders.AreDecidedToTheLastBit/6
  Seeds/ManyThroughOnePointTogether.KeepTheirSides/1
  Seeds/ManyThroughOnePointTogether.KeepTheirSides/2
  Seeds/ManyThroughOnePointTogether.KeepTheirSides/3
  # the other scenes of ParallelRun
  Scenes/ParallelRun.IsThatOfOneThread/rare
  # the other tests of SearchEquivalence
  SearchEquivalence.HoldsForManyNeedlesOverManyCollisions
  PROPERTIES LABELS long)
