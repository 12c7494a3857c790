"""Ctrl-C: KeyboardInterrupt, soon, and the same trajectory."""

import os
import signal
import threading
import time
import unittest

from needlework import Simulation, predict

from support import ELASTIC, GAS, InFolder


class Interrupt(InFolder):
    def setUp(self):
        super().setUp()
        # A parent that ignores the signal passes that on to its children.
        self.former = signal.signal(signal.SIGINT, signal.default_int_handler)

    def tearDown(self):
        signal.signal(signal.SIGINT, self.former)

    def press_after(self, delay):
        def press():
            time.sleep(delay)
            self.pressed = time.monotonic()
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=press)
        thread.start()
        self.addCleanup(thread.join)

    def test_raises_and_changes_no_trajectory(self):
        sim, whole = Simulation(ELASTIC), Simulation(ELASTIC)
        for press in range(3):
            self.press_after(0.05)
            with self.assertRaises(KeyboardInterrupt):
                sim.run(time=1e12, wall_s=600)
            # A tenth of a second on an idle machine; this one may be busy.
            self.assertLess(time.monotonic() - self.pressed, 20)
        end = 2 * sim.totals.collisions / len(sim) + 5
        self.assertEqual(sim.run(collisions_per_needle=end), "collisions")
        whole.run(collisions_per_needle=end)
        self.assertGreater(sim.totals.collisions, 500)
        self.assertEqual(sim.hash, whole.hash)
        self.assertEqual(sim.time, whole.time)

    def test_acts_while_callbacks_are_called(self):
        counted = []
        sim = Simulation(ELASTIC)
        sim.on_collisions(lambda rows: counted.append(len(rows)), 10)
        self.press_after(0.2)
        with self.assertRaises(KeyboardInterrupt):
            sim.run(time=1e12, wall_s=600)
        sim.advance(collisions=1)
        # The one batch whose callback was interrupted may not have counted itself.
        self.assertLessEqual(sim.totals.collisions - sum(counted), 10)

    def test_stops_drawing_a_state(self):
        file = self.folder / "large.h5"
        self.press_after(0.05)
        with self.assertRaises(KeyboardInterrupt):
            Simulation("needles = { count = 5_000_000, box = 200 }\n"
                       f"output.file = '{file}'")
        # It would be there if the simulation had been made.
        self.assertFalse(file.exists())

    def test_stops_the_first_search(self):
        sim = Simulation("needles = { count = 150_000, box = 2.01 }")
        self.assertEqual(sim.counters.searches, 0)
        self.press_after(0.1)
        with self.assertRaises(KeyboardInterrupt):
            sim.run(collisions=1)
        self.assertEqual(sim.totals.collisions, 0)
        self.assertLess(sim.counters.searches, 150_000)
        self.assertEqual(sim.run(collisions=1, wall_s=0.01), "wall_time")

    def test_stops_predictions(self):
        state = Simulation(GAS)
        first = (state.position, state.orientation, state.velocity, state.angular_velocity)
        pairs = [array[:, None] for array in first], [array[None, :] for array in first]
        self.press_after(0.1)
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(10000):
                predict(*pairs[0], *pairs[1], 10.0, accuracy="rigorous")


if __name__ == "__main__":
    unittest.main()
