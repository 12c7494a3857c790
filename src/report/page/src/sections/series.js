// What charts over time have in common.
import { column, numbers } from "../data.js";

export const divided = (a, b) => a.map((value, n) => value / b[n]);

/** The sums over all needles: times, and a function of the name of a sum. */
export function totals(groups) {
  const { datasets, time } = groups.totals;
  return { t: numbers(time), of: (name, component) => column(datasets[name], component) };
}

/** Those curves that there are, with a number to show. */
export function compact(curves) {
  return curves.filter((curve) => curve && curve.x && curve.y?.some(Number.isFinite));
}

/** Samples at multiples of one interval belong to a steady state, which is shown on a linear axis. */
export function isGeometric(times) {
  const middle = times[Math.floor(times.length / 2)];
  return middle < 0.3 * times.at(-1);
}
