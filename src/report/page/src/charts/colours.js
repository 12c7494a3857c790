// The colours of curves and of continuous scales.
import { interpolatePlasma, interpolateRdBu, interpolateViridis } from "d3-scale-chromatic";

const curves = 8;

/** The colour of the n-th curve; that of text for a negative n. */
export function colourOf(n) {
  return n < 0 ? "var(--ink)" : `var(--curve-${n % curves})`;
}

/** Scales by name: the colour at 0 to 1. `diverging` has its middle at 0.5. */
export const scales = {
  sequential: interpolateViridis,
  diverging: (share) => interpolateRdBu(1 - share),
  needles: interpolatePlasma,
};

/** A gradient in CSS from the beginning of a scale to its end. */
export function gradientOf(scale, from = 0, to = 1) {
  const stops = Array.from({ length: 11 }, (_, n) => scale(from + ((to - from) * n) / 10));
  return `linear-gradient(to right, ${stops.join(", ")})`;
}
