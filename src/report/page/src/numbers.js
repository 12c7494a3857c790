// Numbers as people read them.

const raised = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** "10⁻³" */
export function powerOfTen(exponent) {
  return "10" + [...String(exponent)].map((c) => raised[c]).join("");
}

/** "0.0123", "1.23×10⁻⁷", "12 345"; "–" for what is undefined. */
export function numberText(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (Number.isInteger(x) && size < 1e7) return grouped(x);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = x.toExponential(digits - 1).split("e");
    return `${minus(String(Number(mantissa)))}×${powerOfTen(Number(exponent))}`;
  }
  const rounded = Number(x.toPrecision(digits));
  return Number.isInteger(rounded) ? grouped(rounded) : minus(String(rounded));
}

/** A whole number with thin spaces between thousands from 10000 on. */
function grouped(x) {
  const text = String(Math.abs(x));
  const spaced = text.length > 4 ? text.replace(/\B(?=(\d{3})+$)/g, "\u202f") : text;
  return x < 0 ? "−" + spaced : spaced;
}

function minus(text) {
  return text.replace("-", "−");
}

/** A tick of a logarithmic axis. */
export function logTickText(x) {
  const exponent = Math.log10(x);
  const whole = Math.round(exponent);
  if (Math.abs(exponent - whole) > 1e-9) return numberText(x);
  return whole >= -2 && whole <= 3 ? numberText(10 ** whole) : powerOfTen(whole);
}

/** Powers of ten in the range, at most `most`; over less than two decades also their multiples. */
export function logTicks([low, high], most = 7) {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const stride = Math.max(1, Math.ceil((last - first + 1) / most));
  const ticks = [];
  const multiples = last - first < 2 ? [1, 2, 5] : [1];
  for (let exponent = first - 1; exponent <= last; exponent += 1) {
    if (stride > 1 && exponent % stride !== 0) continue;
    for (const multiple of multiples) ticks.push(multiple * 10 ** exponent);
  }
  const inside = ticks.filter((x) => x >= low * (1 - 1e-9) && x <= high * (1 + 1e-9));
  return inside.length >= 2 ? inside : linearTicks(low, high);
}

function linearTicks(low, high) {
  const step = 10 ** Math.floor(Math.log10((high - low) / 2 || 1));
  const spread = (high - low) / step > 6 ? 2 * step : step;
  const ticks = [];
  for (let n = Math.ceil(low / spread); n * spread <= high; ++n) ticks.push(n * spread);
  return ticks;
}
