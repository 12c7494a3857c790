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

// Those of `needlework view`: blue and red that meet in a dull middle, to be told from the ground.
const blueToRed = {
  dark: ["#8cd0ff", "#3d8fe8", "#355894", "#55505c", "#944538", "#ec6a3c", "#ffbe85"],
  light: ["#104e9e", "#5f9bcc", "#c8c8c8", "#e07f5c", "#a51025"],
};

/** Blue to red on a ground that is dark or light: the colour at 0 to 1. */
export const blueToRedOn = (ground) => mixedOf(blueToRed[ground]);

/** The colour at 0 to 1 between colours at equal steps. */
function mixedOf(colours) {
  const part = (text, n) => parseInt(text.slice(1 + 2 * n, 3 + 2 * n), 16);
  return (share) => {
    const place = Math.min(Math.max(share, 0), 1) * (colours.length - 1);
    const before = Math.min(Math.floor(place), colours.length - 2);
    const between = (n) => Math.round(part(colours[before], n) + (place - before) * (part(colours[before + 1], n) - part(colours[before], n)));
    return `rgb(${between(0)}, ${between(1)}, ${between(2)})`;
  };
}

/** A gradient in CSS from the beginning of a scale to its end. */
export function gradientOf(scale, from = 0, to = 1) {
  const stops = Array.from({ length: 11 }, (_, n) => scale(from + ((to - from) * n) / 10));
  return `linear-gradient(to right, ${stops.join(", ")})`;
}
