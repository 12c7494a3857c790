// A configuration of DynamO, written by hand after the reference of its format.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace needlework::io {

/// Two lines of length 2, mass 2 and moment of inertia 2/3, with epsilon = 0.9.
inline const std::string dynamo_text = R"(<?xml version="1.0"?>
<DynamOconfig version="1.5.0">
  <Simulation lastMFT="1.20000000000000000e-01">
    <Scheduler Type="NeighbourList">
      <Sorter Type="BoundedPQMinMax3"/>
    </Scheduler>
    <SimulationSize x="8.00000000000000000e+00" y="9" z="10.5"/>
    <Genus>
      <Species InertiaConstant="3.33333333333333315e-01" Mass="2" Name="Bulk" Type="Lines">
        <IDRange Type="All"/>
      </Species>
    </Genus>
    <BC Type="PBC"/>
    <Topology/>
    <Interactions>
      <Interaction Type="Lines" Length="2" Elasticity="0.9" Name="Bulk">
        <IDPairRange Type="All"/>
        <CaptureMap>
          <Pair ID1="0" ID2="1" val="1"/>
        </CaptureMap>
      </Interaction>
    </Interactions>
    <Locals/>
    <Globals>
      <Global Type="Cells" Name="SchedulerNBList"/>
    </Globals>
    <SystemEvents/>
    <Dynamics Type="Newtonian"/>
  </Simulation>
  <Properties/>
  <ParticleData OrientationData="Y">
    <Pt ID="0">
      <P x="-3.89999999999999991e+00" y="0.1" z="5.24999999999999911e+00"/>
      <V x="1.00000000000000006e-01" y="-2" z="1e-3"/>
      <O x="0" y="1.5" z="0"/>
      <U x="0" y="7.07106781186547573e-01" z="0" w="7.07106781186547573e-01"/>
    </Pt>
    <Pt ID="1">
      <P x="1" y="2" z="-3"/>
      <V x="0.3" y="0.2" z="-0.1"/>
      <O x="0.1" y="0.2" z="0"/>
      <U x="0" y="0" z="0" w="1"/>
    </Pt>
  </ParticleData>
</DynamOconfig>
)";

}  // namespace needlework::io
