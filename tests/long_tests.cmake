# Tests of GoogleTest with the label long, beside their other labels: ctest reads this list. .ci/run runs
# them; ./test.sh, which is to take minutes, does not. The first repeat at length, on more seeds or on
# every instruction set, what shorter tests check, which the comments name.
set_tests_properties(
  # OneTrajectory.OfThreads
  OneTrajectory.OfThreadsOnEveryInstructionSet
  # Continuing.AKillAtAnyMomentLosesNothing, Continuing.AFullDiskLosesNothing
  Continuing.AKillInAnyWriteLosesNothing
  Continuing.AKillWhileRowsAreRemovedLosesNothing
  Failing.AnyWriteMayFindTheDiskFull
  # the first of these seeds, below
  Seeds/Borders.AreDecidedToTheLastBit/1
  Seeds/Borders.AreDecidedToTheLastBit/6
  Seeds/ManyThroughOnePointTogether.KeepTheirSides/1
  # SlidingAgainstQuad.EndsAndMovesAsAContactHeldByAForce
  SlidingAgainstQuadAtLength.EndsAndMovesAsAContactHeldByAForce
  # SlidingCollapse.EndsAsInQuad
  Rules/SlidingCollapses.EndAsInQuadAThousandTimes/epsilon0p5
  # other scenes of ParallelRun
  Scenes/ParallelRun.IsThatOfOneThread/rare
  # Walls.KeepAnAccountOfTheEnergyThatCloses
  Walls.KeepAnAccountThatClosesOverAMillionHits
  # the other tests of SearchEquivalence
  SearchEquivalence.HoldsForManyNeedlesOverManyCollisions
  # RodPressure.IsThatOfTheVirialSeries
  RodPressure.IsThatOfTheVirialSeriesToSomeThousandths
  # the same to 0.7 %, 1 % and 2 %
  PairsBetweenWalls.CollideAtTheseRatesToThousandths
  NeedlesOnAFloor.HaveTheBarometricDensityToThousandths
  ThermalWalls.CarryHeatToThousandths
  # the same of 6 needles
  Needles/FiniteCount.RateAndTemperaturesAreExact/24
  Needles/FiniteCount.RateAndTemperaturesAreExact/24_between_walls
  Needles/FiniteCount.RateAndTemperaturesAreExact/6_in_a_thermostat
  Needles/FiniteCount.RateAndTemperaturesAreExact/6_between_thermal_walls
  # DrawnRods.CollideAndCoolAtTheExactRates
  DrawnRods.CollideAndCoolAtTheExactRatesForEveryShape
  # RodContacts.HaveExponentialEnergiesAtEveryDensity
  RodContacts.HaveExponentialEnergiesInMillionsOfCollisions
  PROPERTIES LABELS long)
# PredictOracle.AgreesOnEveryPair: the first tenth of these pairs
foreach(family thermal_k6 thermal_k2 parallel tip grazing just_collided fast_spin still slow planar
               mixed_scales parallel_to_rounding tip_to_rounding back_to_rounding tip_to_tip
               grazing_to_rounding)
  set_tests_properties(Families/PredictOracle.AgreesOnEveryPairOfMany/${family} PROPERTIES LABELS long)
endforeach()
# Minutes each, or more seeds of the same: slow. DiluteRods.CollideAtTheExactRates,
# RodPressure.OfDenseFluidsIsThatOfOthers and the first seeds are in ./test.sh or above.
set_tests_properties(
  Seeds/Borders.AreDecidedToTheLastBit/2
  Seeds/Borders.AreDecidedToTheLastBit/3
  Seeds/Borders.AreDecidedToTheLastBit/4
  Seeds/Borders.AreDecidedToTheLastBit/5
  Seeds/ManyThroughOnePointTogether.KeepTheirSides/2
  Seeds/ManyThroughOnePointTogether.KeepTheirSides/3
  RodPressure.OfDenseFluidsIsThatOfOthersToSomeThousandths
  Rules/SlidingCollapses.EndAsInQuadAThousandTimes/epsilon0p8
  PROPERTIES LABELS slow)
foreach(rods spheres L1 L5 L100 unequal)
  set_tests_properties(Rods/DiluteRods.CollideAtTheExactRatesToThreeThousandths/${rods}
                       PROPERTIES LABELS slow)
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
# Tests that take more than about three seconds, beside shorter ones of the same subject.
foreach(test
    Audit.FollowsBouncesDownToTheContactTime
    Audit.GoesOnWhereItWasInterrupted
    AuditCommand.GoesOnWhereItWasInterrupted
    AuditOfKicks.FindsNothingWrongWithTheEngine
    CheckpointFile.CutShortAtAnyByteIsDamaged
    CheckpointFile.WithAnyByteChangedIsDamaged
    ContactFinder.EndsSoonForNeedlesInOnePlane
    Continuing.AFileContinuesWhereItWasClosed
    Continuing.RowsBeyondThePositionDoNotRemain
    Crash.KillAtAnyMomentLeavesTheFlushedFrames
    FalseReport.OfACollisionThatWasNotIsSeen
    FalseReport.OfAnyNumberIsSeen
    Families/ContactFinderOracle.FindsTheSameContacts/grazing_to_rounding
    Forecast.OfAMixtureIsThatOfItsSpecies
    Formats.FilesOfManyBlocksAreReadWhetherCompressedOrNot
    Hostile.CompressedBombsAreRefused
    NeverColliding.StatesAreNamedAndNeedALimitOnTime
    Oracle.DoublesSettleOnlyWhatIsClear
    Overlapping.LosesNoCapsulesThatCrossAtSmallAngles
    PredictCommand.GivesUpAPairThatItCannotDecide
    PredictCommand.GivesUpPairsThatTurnNearEachOtherForEver
    Prepare.IsStoppedBeforeTheFirstEventAndContinues
    Range.SineAndCosineEncloseThoseOfAllAngles
    Reading.FilesCutShortAreRefused
    RunCommand.DrawsOneLineOfProgressOnATerminal
    Scenes/MixtureSearches.GiveOneTrajectory/one_to_four_dense
    Scenes/MixtureSearches.GiveOneTrajectory/one_to_twenty
    Scenes/MixtureSearches.GiveOneTrajectory/one_to_twenty_dense
    Scenes/SearchEquivalence.GivesThoseOfAllPairs/cooling_by_decades
    Scenes/SearchEquivalence.GivesThoseOfAllPairs/strongly_cooling
    Scenes/SearchEquivalence.GivesThoseOfAllPairs/very_dense
    Scenes/SearchEquivalence.GivesThoseOfAllPairs/very_dilute
    SetVelocities.IsTheSameOnThreadsThatShareTheWork
    SetVelocities.OfManyThroughOnePointKeepTheirSides
    Settings/Contacts.AreProposedByEverySearch/chained_blocks
    Settings/Contacts.AreProposedByEverySearch/dilute
    Settings/Contacts.AreProposedByEverySearch/side_next_to_whole
    Settings/Contacts.AreProposedByEverySearch/some_fast
    Simulation.TellsTheTimesOfCollisions
    SourceOfEvents.HasOneTrajectoryOnThreads
    SpeciesOfAnyLength.HaveOneTrajectoryOnEverySearch
    SweepCommand.GoesOnAfterSignals
    SweepCommand.KeepsAMemberThatAnotherProgramHasOpen
    SweepCommand.SummaryDoesNotDependOnThreadsOrShares
    SweepCommand.TwoSweepsOfOneFolderDoNotRunTheSame
    SweepOverRanks.GoOnAfterASignal
    SweepOverRanks.NoOtherCommandRunsOnSeveral
    SweepOverRanks.WriteOneLogOfWholeLines
    TableOfSpecies.OfLengthAndMassOneChangesNoBitOnThreads
    WallContact.IsThatOfSamplingInQuad
    WithoutLocks.StoppedRunsAndSweepsGoOn)
  set_tests_properties(${test} PROPERTIES LABELS "unit;long")
endforeach()
foreach(test
    Boltzmann.SingleCollisionsRelaxMoreSlowlyThanGaussianOnes
    CentreOnCentre.HasASideOnceAThirdStrikes
    CollapseOfThree.IsTheSameInQuad
    Density.MayBeTwoHundred
    Elastic/ContactDistribution.IsExactInEquilibrium/k20_n3
    Elastic/Relaxation.StartsAtItsRate/k2
    Elastic/Relaxation.StartsAtItsRate/k6
    ElasticMixture.CollidesAtTheExactRates
    Families/PredictOracle.AgreesOnUnequalNeedles/parallel_to_rounding
    Inertia.MayBeOfAnySize
    KickPower.IsExactForFewNeedles
    KickPower.IsExactForInelasticNeedles
    KickPower.IsExactForMixtures
    LongTimes.EnergyFallsBy30Decades
    ManyThroughOnePoint.MayStartThere
    NeedlesOnAFloor.HaveTheBarometricDensity
    OfLengthAndMass/ElasticRate.IsExactInEquilibrium/k2_n20
    OnePlane.AndParallelNeedlesNeverMeet
    OnePlane.TiltedGoesOnOrSaysWhyNot
    OnePlane.TiltedRattles
    PairsBetweenWalls.CollideAtTheRatesOfEachTwoSpecies
    Restitution.MayBeAnyOfItsRange
    Restitution.WithoutContactTimeEndsInAClearError
    Rough/ElasticRate.IsExactInEquilibrium/k6_n3
    Rough/MixtureAtTheStart.HasExactRates/three
    Rules/CollapseInQuad.WithContactTimeIsTheSame/epsilon0p3_beta0
    Seeds/Borders.AreDecidedToTheLastBit/0
    Seeds/ManyThroughOnePointTogether.KeepTheirSides/0
    Smooth/ElasticRate.IsExactInEquilibrium/k2_n20
    Smooth/ElasticRate.IsExactInEquilibrium/k6_n0p72
    Smooth/MixtureAtTheStart.HasExactRates/dense_1_to_10
    Subnormal.ComponentsChangeNothing
    ThermalWalls.BringTheGasToTheirTemperature
    ThermalWalls.CarryHeatFromTheHotOneToTheCold
    Thermostat.GivesItsTemperatureToFewNeedles
    Thermostat.RelaxesExponentially
    WallPressure.IsThatOfTheIdealGasOfNeedles
    WallProfilesOfAnElasticGas.AreExactAboveAFloor
    WallProfilesOfAnElasticGas.AreExactBetweenWalls
    WallsStepByStep.OfNeedlesBetweenTwoWalls
    WallsStepByStep.OfRoughNeedlesOnAFloor)
  set_tests_properties(${test} PROPERTIES LABELS "physics;long")
endforeach()
foreach(test
    Cloud.IsFollowedAsItSpreads
    HostThreads.RunSimulationsOnDifferentInstructionSets
    Loops.CountTogetherWhatHappensAtOneInstant
    Parallel.HasTheSameTrajectoryForFewNeedles
    Parallel.IsTheSameEveryTime
    Parallel.RollsBackAPhaseOnlyOnce
    Parallel.StopsWhereOneThreadStops
    RandomScenes.EndAsOnOneThread
    Scenes/ParallelRun.IsThatOfOneThread/dense
    Scenes/ParallelRun.IsThatOfOneThread/dilute
    Scenes/ParallelRun.IsThatOfOneThread/swift_rotation)
  set_tests_properties(${test} PROPERTIES LABELS "threads;long")
endforeach()
