// Means of a run at each phase of the motion of a wall.
import { column } from "../data.js";

const bins = 16;
const fewest = 4; // bins with samples, or the samples are all at nearly the same phases

/** The same curves, without the dashed ones, over the phase of the first wall that moves: means over
 * the later half of the samples, in bins centred at multiples of a sixteenth of a turn. None where no
 * wall moves, or where samples are at few phases. */
export function byPhase({ groups }, curves) {
  const phases = phasesOf(groups.walls);
  if (!phases) return [];
  const measured = curves.filter((curve) => curve && !curve.dashed);
  return measured.map((curve) => meansOf(curve, phases)).filter(({ x }) => x.length >= fewest);
}

// In turns, of each sample.
function phasesOf({ datasets }) {
  if (!datasets.phase) return null;
  const walls = datasets.phase.shape[1];
  for (let wall = 0; wall < walls; ++wall) {
    const phases = column(datasets.phase, wall);
    if (phases.every(Number.isFinite)) return phases.map((phase) => phase / (2 * Math.PI));
  }
  return null;
}

function meansOf(curve, phases) {
  const sums = new Float64Array(bins);
  const counts = new Float64Array(bins);
  for (let n = Math.floor(curve.y.length / 2); n < curve.y.length; ++n) {
    if (!Number.isFinite(curve.y[n])) continue;
    const bin = Math.round(phases[n] * bins) % bins;
    sums[bin] += curve.y[n];
    counts[bin] += 1;
  }
  const filled = [...counts.keys()].filter((bin) => counts[bin] > 0);
  return {
    name: curve.name, colour: curve.colour, points: true,
    x: Float64Array.from(filled, (bin) => bin / bins), y: Float64Array.from(filled, (bin) => sums[bin] / counts[bin]),
  };
}
