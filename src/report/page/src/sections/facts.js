// What was run, and what came out, as lists of facts.
import { element } from "../dom.js";
import { column, numbers, rowOf } from "../data.js";
import { boundaryText, openSides, sideName } from "../boundaries.js";
import { numberText } from "../numbers.js";

/** A list of [name, value, remark] as large figures or as lines. */
export function factList(facts, kind) {
  return element(
    "dl",
    { class: kind },
    facts
      .filter(([, value]) => value !== null && value !== undefined && value !== "")
      .map(([name, value, remark]) =>
        element(
          "div",
          {},
          element("dt", {}, name),
          element("dd", {}, typeof value === "number" ? numberText(value) : value, remark ? element("small", {}, ` ${remark}`) : null),
        ),
      ),
  );
}

function endText({ time, collisions_per_needle, energy_ratio, wall_s }) {
  const ends = [
    time !== null && `time ${numberText(time)}`,
    collisions_per_needle !== null && `${numberText(collisions_per_needle)} collisions per needle`,
    energy_ratio !== null && `E/E(0) = ${numberText(energy_ratio)}`,
    wall_s !== null && `${numberText(wall_s)} s of wall-clock time`,
  ];
  return ends.filter(Boolean).join(", or ");
}

function contactTime({ tc, tc_relative }) {
  if (tc !== null) return `t_c = ${numberText(tc)}`;
  return tc_relative === null ? "none" : `t_c = ${numberText(tc_relative)} mean free times`;
}

function slidingText({ sliding_below }) {
  return sliding_below === null ? null : `where flights are below ${numberText(sliding_below)} mean free times`;
}

function ofOneSpecies({ k, length, diameter, mass, differ }) {
  const numbers = (names) => (differ ? `Means of ${names}` : names[0].toUpperCase() + names.slice(1));
  if (diameter > 0) {
    return [
      ["Shape k", length > 0 ? k : null],
      [numbers("length, diameter, mass"), [length, diameter, mass].map((value) => numberText(value)).join(", ")],
    ];
  }
  return [
    ["Shape k", k],
    [numbers("length, mass"), length === 1 && mass === 1 ? null : `${numberText(length)}, ${numberText(mass)}`],
  ];
}

function speciesFact({ name, count, fixed, differ, length, diameter, mass, k, t_tr, t_rot, rotations }) {
  const width = diameter > 0 ? { diameter } : {};
  const axis = length > 0 ? { k } : {};
  const turns = rotations > 0 ? { "T_rot": t_rot } : {};
  const properties = { length, ...width, ...(fixed ? {} : { mass, ...axis, "T_tr": t_tr, ...turns }) };
  const text = Object.entries(properties).map(([key, value]) => `${key} ${numberText(value)}`);
  const kind = [fixed ? "fixed" : "", differ ? "means" : ""].filter(Boolean).map((word) => `, ${word}`).join("");
  return [`Species ${name}`, `${numberText(count)} needles${kind}: ${text.join(", ")}`];
}

function wallFact({ axis, side, epsilon, temperature, motion }) {
  const parts = [temperature === null ? `ε = ${numberText(epsilon)}` : `temperature ${numberText(temperature)}`];
  if (motion?.amplitude > 0) {
    const phase = motion.phase ? ` + ${numberText(motion.phase)}` : "";
    parts.push(`moves by ${numberText(motion.amplitude)} sin(2π ${numberText(motion.frequency)} t${phase})`);
  }
  if (motion?.velocity) {
    const stop = motion.stop_at === undefined ? "" : ` until it stops at ${numberText(motion.stop_at)}`;
    parts.push(`moves at ${numberText(motion.velocity)} along ${axis}${stop}`);
  }
  if (motion?.tangential) {
    const others = ["x", "y", "z"].filter((other) => other !== axis);
    parts.push(`slides at ${motion.tangential.map((speed, n) => `${numberText(speed)} along ${others[n]}`).join(", ")}`);
  }
  return [`Wall at ${axis} ${side}`, parts.join(", ")];
}

function growthText({ rate, until_packing: packing, until_pressure: pressure }) {
  const ends = [packing && `to a packing fraction of ${numberText(packing)}`, pressure && `to P V / (N T) = ${numberText(pressure)}`];
  return [`rate ${numberText(rate)}`, ...ends.filter(Boolean)].join(", ");
}

function drivingFacts({ kicks, andersen, growth }) {
  return [
    kicks && [
      "Kicks",
      `every ${numberText(kicks.every)}, ξ_tr = ${numberText(kicks.translational)}, ξ_rot = ${numberText(kicks.rotational)}`,
    ],
    andersen && ["Thermostat", `T = ${numberText(andersen.temperature)} at the rate ${numberText(andersen.rate)} of each needle`],
    growth && ["Growth", growthText(growth)],
  ].filter(Boolean);
}

function gravityText(gravity) {
  return gravity.some((g) => g !== 0) ? gravity.map((g) => numberText(g)).join(", ") : null;
}

/** The weight that a wall bears in the mean over time: that of all needles, where it is the only wall
 * of its axis; null otherwise. */
export function weightOn({ axis, high }, { scene, frames }) {
  const gravity = scene?.gravity[axis] ?? 0;
  const bears = high ? gravity > 0 : gravity < 0;
  const alone = openSides(frames).some((side) => side.axis === axis);
  return bears && alone ? frames.needles_in_file * scene.mass * Math.abs(gravity) : null;
}

/** How many rotational degrees of freedom the bodies have, of a mixture those of one species; undefined
 * where the file does not say. */
export function rotationsOf(scene, species) {
  return (species === undefined ? scene : scene?.species.find(({ name }) => name === species))?.rotations;
}

/** What puts energy in, as the budget of energy names it, in words. */
export function sourceName(name) {
  return name === "pairs" ? "collisions" : name.replaceAll("_", " ");
}

/** The area of the face of the box at which a wall is. */
export function areaOf({ axis }, { frames }) {
  return frames.box.reduce((product, edge, n) => (n === axis ? product : product * edge), 1);
}

/** The walls of the series, in its order, as sides. */
export function wallsOf({ groups }) {
  const { axis, high } = groups.walls.datasets;
  return Array.from(numbers(axis), (n, index) => ({ axis: n, high: numbers(high)[index] === 1 }));
}

// Since the first sample.
function resultsAtWalls(run) {
  const { groups, frames } = run;
  if (!groups.walls) return [];
  const { datasets, time } = groups.walls;
  const since = numbers(time).at(-1) - numbers(time)[0];
  const gained = (name, n) => {
    const values = column(datasets[name], n);
    return values.at(-1) - values[0];
  };
  return wallsOf(run).flatMap((wall, n) => {
    const hits = gained("hits", n);
    if (!(since > 0)) return [[`Hits at ${sideName(wall)}`, hits]];
    const weight = weightOn(wall, run);
    return [
      [`Hits at ${sideName(wall)}`, hits, `${numberText(hits / since / frames.needles_in_file)} per needle and time`],
      [`Force at ${sideName(wall)}`, gained("impulse", n) / since, weight ? `weight: ${numberText(weight)}` : "mean over time"],
    ];
  });
}

// Contacts of needles that slide on each other, since the start of the run: all that the file says.
function resultsOfContacts({ groups }) {
  if (!groups.contacts) return [];
  return Object.entries(groups.contacts.datasets).map(([name, dataset]) => [
    `Contacts: ${name.replaceAll("_", " ")}`,
    column(dataset).at(-1),
  ]);
}

// Bodies that grow, at the last sample.
function resultsOfGrowth({ groups }) {
  return ["growth", "contact_network"].flatMap((group) =>
    Object.entries(groups[group]?.datasets ?? {}).map(([name, dataset]) => [
      `${group === "growth" ? "Growth" : "Network"}: ${name.replaceAll("_", " ")}`,
      column(dataset).at(-1),
    ]),
  );
}

// Temperatures of each species at the last sample, and collisions of each two.
function resultsBySpecies({ groups, scene }) {
  if (!groups.species || !scene?.species.length) return [];
  const last = (dataset) => rowOf(dataset, dataset.shape[0] - 1);
  const { t_tr, t_rot, collisions } = groups.species.datasets;
  const theory = groups.theory?.datasets.species_t_tr;
  const names = scene.species.map(({ name }) => name);
  const temperatures = names.flatMap((name, n) => [
    [`T_tr of ${name}`, last(t_tr)[n], theory ? `${numberText(last(t_tr)[n] / last(theory)[n])} × theory` : ""],
    [`T_rot of ${name}`, last(t_rot)[n], theory ? `${numberText(last(t_rot)[n] / last(groups.theory.datasets.species_t_rot)[n])} × theory` : ""],
  ]);
  return [...temperatures, ...pairNames(names).map((name, n) => [`Collisions ${name}`, last(collisions)[n]])];
}

/** Of each two species, in the order in which they are counted. */
export function pairNames(names) {
  return names.flatMap((name, n) => names.slice(n).map((other) => `${name}-${other}`));
}

/** The scene and the settings of a run. */
export function factsOfRun({ scene, parameters, frames }) {
  const value = (name) => parameters[name]?.value;
  const facts = [["Needles", frames.needles_in_file]];
  if (scene) {
    const volume = frames.box.reduce((a, b) => a * b, 1);
    const when = scene.walls.some(({ motion }) => motion?.velocity) ? "at the start" : "";
    facts.push(
      ["Box", frames.box.map((edge) => numberText(edge)).join(" × "), when],
      ["Boundaries", boundaryText(frames)],
      ...scene.walls.map(wallFact),
      ["Gravity", gravityText(scene.gravity)],
      ["Shear", scene.shear_rate === null ? null : `rate ${numberText(scene.shear_rate)}, flow along x that grows with y`],
      ...drivingFacts(scene.driving),
      ["Density n L³", openSides(frames).length || scene.packing_fraction !== null ? null : (frames.needles_in_file * scene.length ** 3) / volume, when],
      ["Restitution ε, β", `${numberText(scene.epsilon)}, ${numberText(scene.beta)}`],
      ...scene.pairs.map(({ name, meet, epsilon, beta }) => [`Restitution of ${name}`, meet === false ? "none: they pass through each other" : `${numberText(epsilon)}, ${numberText(beta)}`]),
      ...(scene.species.length ? scene.species.map(speciesFact) : ofOneSpecies(scene)),
      ["Packing fraction", scene.packing_fraction, when],
      ["Initial state", scene.initial_file || (scene.species.length ? "drawn" : `drawn, T_tr = ${numberText(scene.t_tr)}, T_rot = ${numberText(scene.t_rot)}`)],
      ["Contact-time rule", scene.sliding_below === null ? contactTime(scene) : null],
      ["Sliding contact", slidingText(scene)],
      ["Started to run until", endText(scene.until)],
      ["Search, calendar", `${scene.search}, ${scene.queue}`],
    );
  }
  facts.push(
    ["Seed", value("seed")],
    ["Accuracy", value("accuracy")],
    ["Instruction set", value("isa")],
    ["Threads", value("threads")],
    ["Version", value("version")],
  );
  return facts;
}

/** The last sample of a run. */
export function resultsOfRun(run) {
  const { groups, scene, frames } = run;
  if (!groups.totals) return [];
  const { datasets, time } = groups.totals;
  const told = new Set();
  const last = (name) => {
    told.add(name);
    return column(datasets[name]).at(-1);
  };
  const theory = (name) => groups.theory && column(groups.theory.datasets[name]).at(-1);
  const energy = last("energy") / column(datasets.energy)[0];
  const beside = (measured, expected) => (expected ? `${numberText(measured / expected)} × theory` : "");
  const collisions = last("collisions");
  const order = groups.flow_order && column(groups.flow_order.datasets.translational).at(-1);
  const results = [
    ["Time", numbers(time).at(-1)],
    ["E/E(0)", energy, beside(last("energy"), theory("energy"))],
    ["T_tr", last("t_tr"), beside(last("t_tr"), theory("t_tr"))],
    ["T_rot", last("t_rot"), beside(last("t_rot"), theory("t_rot"))],
    ["T_tr/T_rot", last("t_rot") > 0 ? last("t_tr") / last("t_rot") : null, scene?.ratio_of_theory ? `theory, late: ${numberText(scene.ratio_of_theory)}` : ""],
    ["Collisions", collisions, `${numberText((2 * collisions) / frames.needles_in_file)} per needle`],
    ["Elastic by the t_c rule", last("tc_collisions"), collisions ? `${numberText((100 * last("tc_collisions")) / collisions, 3)} %` : ""],
    ["S", order],
  ];
  // Sums without a line of their own; vectors have charts.
  const rest = Object.keys(datasets).filter((name) => !told.has(name) && datasets[name].has_rows && datasets[name].shape.length === 1);
  return [
    ...results,
    ...rest.map((name) => [name.replaceAll("_", " "), last(name)]),
    ...resultsOfContacts(run),
    ...resultsOfGrowth(run),
    ...resultsAtWalls(run),
    ...resultsBySpecies(run),
  ];
}

/** A text of several lines that is opened. */
export function textBehind(title, text) {
  return text ? element("details", { class: "behind" }, element("summary", {}, title), element("pre", { tabindex: 0 }, text)) : null;
}
