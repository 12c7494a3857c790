// The section of one run.
import { element, shownOrFailed, slider } from "../dom.js";
import { numbers } from "../data.js";
import { numberText } from "../numbers.js";
import { curvesChart } from "../charts/curves.js";
import { fieldMap } from "../charts/field_map.js";
import { needlesView } from "../needles/view.js";
import { factList, factsOfRun, resultsOfRun, textBehind } from "./facts.js";
import { notesOf, timelinesOf } from "./timelines.js";
import { snapshotsOf } from "./snapshots.js";

/** Elements of the section. */
export function runSection(run) {
  return [
    element("h3", {}, "Results"),
    ...shownOrFailed("Results", () => factList(resultsOfRun(run), "figures")),
    element(
      "div",
      { class: "beside" },
      needlesView(run.frames),
      element(
        "div",
        {},
        element("h3", {}, "What was run"),
        ...shownOrFailed("Facts", () => factList(factsOfRun(run), "facts")),
        textBehind("Scene", run.parameters.scene?.value),
      ),
    ),
    ...shownOrFailed("Charts over time", () => withHeading("Over time", timelinesOf(run).map(curvesChart))),
    ...shownOrFailed("Charts at one time", () => atOneTime(run)),
  ];
}

function withHeading(title, charts) {
  return charts.length ? [element("h3", {}, title), element("div", { class: "charts" }, charts)] : [];
}

// Histograms, profiles and fields, which one slider moves through time together.
function atOneTime(run) {
  const charts = snapshotsOf(run).map(({ group, chart, curvesAt, rangeAt }) => {
    const last = group.rows - 1;
    const figure = curvesChart({ ...chart, notes: notesOf(group), curves: curvesAt(last), range: rangeAt(last) });
    return { figure, group, show: (row) => figure.update(curvesAt(row), rangeAt(row)) };
  });
  for (const { groups, name } of [{ groups: run.groups }, ...(run.parts ?? [])]) {
    const { fields } = groups;
    if (!fields) continue;
    const notes = name ? [`Of ${name}.`, ...notesOf(fields)] : notesOf(fields);
    const figure = fieldMap(fields, run.frames.box, notes);
    figure.dataset.group = "fields";
    charts.push({ figure, group: fields, show: figure.show });
  }
  if (!charts.length) return [];
  const times = numbers(longest(charts.map(({ group }) => group)).time);
  const show = (n) => {
    for (const { group, show: showRow } of charts) showRow(nearestRow(numbers(group.time), times[n]));
  };
  const control = slider("Time of the charts below", times.length - 1, times.length - 1, (n) => numberText(times[n]), show);
  return [
    element("h3", {}, "At one time"),
    element("div", { class: "sticky" }, control),
    element("div", { class: "charts" }, charts.map(({ figure }) => figure)),
  ];
}

function longest(groups) {
  return groups.reduce((best, group) => (group.rows > best.rows ? group : best));
}

function nearestRow(times, time) {
  let best = 0;
  times.forEach((t, n) => {
    if (Math.abs(t - time) < Math.abs(times[best] - time)) best = n;
  });
  return best;
}
