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
  # Walls.KeepAnAccountOfTheEnergyThatCloses
  Walls.KeepAnAccountThatClosesOverAMillionHits
  # the other tests of SearchEquivalence
  SearchEquivalence.HoldsForManyNeedlesOverManyCollisions
  # RodPressure.IsThatOfTheVirialSeries
  RodPressure.IsThatOfTheVirialSeriesToSomeThousandths
  PROPERTIES LABELS long)
# PredictOracle.AgreesOnEveryPair: the first tenth of these pairs
foreach(family thermal_k6 thermal_k2 parallel tip grazing just_collided fast_spin still slow planar
               mixed_scales parallel_to_rounding tip_to_rounding back_to_rounding tip_to_tip
               grazing_to_rounding)
  set_tests_properties(Families/PredictOracle.AgreesOnEveryPairOfMany/${family} PROPERTIES LABELS long)
endforeach()
# InitialRates of other k, rules and initial temperatures
foreach(gas Smooth:n0p72_k6_epsilon0p8_beta_m1_q0 Rough:n0p72_k2_epsilon1_beta_m0p5_q3
            Rough:n0p72_k20_epsilon0p5_beta0p5_q0 OfLengthAndMass:n0p72_k2_epsilon0p8_beta0p5_q1)
  string(REPLACE ":" "/InitialRates.AreExact/" test ${gas})
  set_tests_properties(${test} PROPERTIES LABELS long)
endforeach()
# ElasticRate at other densities and k: the ends of their ranges here, and what lies between them with
# the label slow
foreach(gas Smooth:k2_n0p72 Smooth:k6_n0p1 Smooth:k6_n100 Smooth:k20_n0p1 OfLengthAndMass:k6_n0p72
            Rough:k6_n0p72)
  string(REPLACE ":" "/ElasticRate.IsExactInEquilibrium/" test ${gas})
  set_tests_properties(${test} PROPERTIES LABELS long)
endforeach()
foreach(gas Smooth:k2_n0p1 Smooth:k2_n3 Smooth:k6_n3 Smooth:k6_n20 Smooth:k6_n50 Smooth:k20_n0p72
            Smooth:k20_n20)
  string(REPLACE ":" "/ElasticRate.IsExactInEquilibrium/" test ${gas})
  set_tests_properties(${test} PROPERTIES LABELS slow)
endforeach()
