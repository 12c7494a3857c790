// Several runs beside each other.
import { element } from "../dom.js";
import { column, numbers } from "../data.js";
import { curvesChart } from "../charts/curves.js";
import { numberText } from "../numbers.js";
import { factsOfRun, resultsOfRun } from "./facts.js";
import { compact, divided } from "./series.js";

/** Elements of the section, for at least two runs with totals. */
export function comparedSection(runs) {
  const energies = runs.map((run, n) => curveOf(run, n, (datasets) => {
    const energy = column(datasets.energy);
    return energy.map((e) => e / energy[0]);
  }));
  const ratios = compact(runs.map((run, n) => curveOf(run, n, ({ t_tr, t_rot }) => divided(column(t_tr), column(t_rot)))));
  const axis = { label: "time", log: true };
  return [
    factsTable(runs),
    element("h3", {}, "Over time"),
    element(
      "div",
      { class: "charts" },
      curvesChart({
        title: "Cooling curves", caption: "Energy per needle, divided by that at the start.",
        x: axis, y: { label: "E/E(0)", log: true }, curves: energies,
      }),
      ratios.length > 0 && curvesChart({
        title: "Ratios of the temperatures", caption: "Of translation to rotation.",
        x: axis, y: { label: "T_tr/T_rot", log: true }, curves: ratios,
      }),
    ),
  ];
}

function curveOf(run, n, valuesOf) {
  const { datasets, time } = run.groups.totals;
  return { name: run.name, x: numbers(time), y: valuesOf(datasets), colour: n };
}

// A column for each run, a row for each fact that differs or is a result.
function factsTable(runs) {
  const all = runs.map((run) => new Map([...factsOfRun(run), ...resultsOfRun(run)]));
  const said = (value) => value !== null && value !== undefined && value !== "";
  const names = [...new Set(all.flatMap((facts) => [...facts.keys()]))].filter((name) => all.some((facts) => said(facts.get(name))));
  const text = (value) => (typeof value === "number" ? numberText(value) : (value ?? "–"));
  return element(
    "div",
    { class: "scroll whole", tabindex: 0, role: "region", "aria-label": "Runs compared" },
    element(
      "table",
      { class: "facts-table" },
      element("caption", {}, "Settings and last samples"),
      element("thead", {}, element("tr", {}, element("td", {}), runs.map((run) => element("th", { scope: "col" }, run.name)))),
      element(
        "tbody",
        {},
        names.map((name) =>
          element("tr", {}, element("th", { scope: "row" }, name), all.map((facts) => element("td", {}, text(facts.get(name))))),
        ),
      ),
    ),
  );
}
