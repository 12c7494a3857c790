"""Daemon threads that are in the library when Python ends."""

import subprocess
import sys
import unittest

PROGRAM = """
import atexit
import threading
import numpy as np

late = []
atexit.register(lambda: [work() for work in late])  # called after what needlework registers
import needlework

def end_when_it_runs(work, begun=lambda: True):
    threading.Thread(target=work, daemon=True).start()
    while not begun():
        pass

sim = needlework.Simulation({"needles": {"count": 300, "box": 7}})
"""

# Each ends while the thread is within the library, or soon back in it.
WORK = {
    "run": "end_when_it_runs(lambda: sim.run(time=1e9))",
    "short calls": """
calls = []
def work():
    while True:
        calls.append(sim.advance(collisions=2))
end_when_it_runs(work, lambda: len(calls) > 10)""",
    "callbacks": """
seen = []
def look(rows):
    seen.append(sum(range(1000)))
sim.on_collisions(look, batch=1)
end_when_it_runs(lambda: sim.run(time=1e9), lambda: len(seen) > 10)""",
    "progress": """
shown = []
class Stream:
    def write(self, text): shown.append(text)
    def flush(self): pass
import sys
sys.stderr = Stream()
end_when_it_runs(lambda: sim.run(time=1e9, progress=True), lambda: shown)""",
    "predictions": """
r = np.zeros((3000, 3))
state = [r, sim.orientation[:1] + r, r, 5 + r, r + 0.3, sim.orientation[1:2] + r, r, 3 + r]
calls = []
def work():
    while True:
        calls.append(needlework.predict(*state, horizon=1))
end_when_it_runs(work, lambda: calls)""",
    "constructors": """
made = []
def work():
    while True:
        made.append(len(needlework.Simulation({"needles": {"count": 300, "box": 7}})))
end_when_it_runs(work, lambda: made)""",
    "functions of atexit": """
other = needlework.Simulation({"needles": {"count": 300, "box": 7}})
for register in (atexit.register, late.append):
    register(lambda: other.advance(collisions=100))
end_when_it_runs(lambda: sim.run(time=1e9))""",
}


class Exit(unittest.TestCase):
    def test_is_that_of_a_program_without_them(self):
        for name, work in WORK.items():
            with self.subTest(name):
                done = subprocess.run([sys.executable, "-c", f"{PROGRAM}{work}\nprint('end')"],
                                      capture_output=True, text=True, timeout=300)
                self.assertEqual((done.returncode, done.stdout), (0, "end\n"), done.stderr)
                self.assertEqual(done.stderr, "")


if __name__ == "__main__":
    unittest.main()
