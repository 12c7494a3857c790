// Laws of probability that histograms are compared with.

/** The mean of a density over each bin, from its integral where that is known. */
export function overBins(borders, { integral, density }) {
  return Float64Array.from({ length: borders.length - 1 }, (_, n) => {
    const [low, high] = [borders[n], borders[n + 1]];
    if (integral) return (integral(high) - integral(low)) / (high - low);
    return meanOf(density, low, high);
  });
}

// By the midpoints of 32 parts.
function meanOf(density, low, high) {
  const parts = 32;
  let sum = 0;
  for (let n = 0; n < parts; ++n) sum += density(low + ((n + 0.5) * (high - low)) / parts);
  return sum / parts;
}

/** Of the energy in units of the temperature, of 2 or 3 Gaussian components; null of none. */
export function energyOf(components) {
  if (components === 3) {
    return { name: "Gaussian", density: (e) => (2 / Math.sqrt(Math.PI)) * Math.sqrt(e) * Math.exp(-e) };
  }
  return components === 2 ? { name: "Gaussian", integral: (e) => 1 - Math.exp(-e) } : null;
}

export const laws = {
  normal: { name: "Gaussian", density: (v) => Math.exp((-v * v) / 2) / Math.sqrt(2 * Math.PI) },
  energyOfTranslation: energyOf(3),
  randomDirectors: { name: "random directors", integral: (q) => Math.sqrt(Math.max(0, q + 1) / 3) },
  angle: { name: "equilibrium", integral: (a) => (a - Math.sin(a) * Math.cos(a)) / Math.PI },
  normalVelocity: { name: "equilibrium", integral: (x) => 1 - Math.exp((-x * x) / 2) },
};

/** Probabilities of 0, 1, 2 ... for a Poisson law. */
export function poisson(mean, length) {
  let logarithm = -mean;
  return Float64Array.from({ length }, (_, n) => {
    if (n > 0) logarithm += Math.log(mean / n);
    return Math.exp(logarithm);
  });
}
