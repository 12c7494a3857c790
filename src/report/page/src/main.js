// The page: a heading, a section for each file, and the licences of the libraries.
import { element } from "./dom.js";
import { readReport } from "./data.js";
import { themeChoice } from "./theme.js";
import { runSection } from "./sections/run.js";
import { sweepSection } from "./sections/sweep.js";
import { benchSection } from "./sections/bench.js";
import { comparedSection } from "./sections/compared.js";

const kinds = {
  run: { word: "Run", make: runSection, titleOf: (run) => run.parameters.title?.value },
  sweep: { word: "Sweep", make: sweepSection, titleOf: () => undefined },
  bench: { word: "Benchmark", make: benchSection, titleOf: ({ about }) => about.subset },
};

function fileName(path) {
  return path.split("/").at(-1);
}

// Files of the same name in different folders are told apart by their paths.
function nameSections(sections) {
  for (const section of sections) {
    const name = fileName(section.file);
    const alone = sections.filter((other) => fileName(other.file) === name).length === 1;
    section.name = alone ? name : section.file;
  }
}

function sectionOf(section, id, pageTitle) {
  const { word, make, titleOf } = kinds[section.kind];
  const title = titleOf(section) || section.name;
  return element(
    "section",
    { id, "aria-labelledby": `${id}-title` },
    element("h2", { id: `${id}-title`, class: title === pageTitle ? "spoken" : undefined }, title),
    element("p", { class: "source" }, `${word}, ${section.file}`),
    make(section),
  );
}

function build(report) {
  const { sections } = report;
  nameSections(sections);
  const titles = sections.map((section) => kinds[section.kind].titleOf(section)).filter(Boolean);
  const title = report.title || titles[0] || "Results";
  document.title = `${title} – Needlework`;
  document.querySelector("h1").textContent = title;
  document.getElementById("made-by").textContent = `needlework report, version ${report.version}`;
  document.getElementById("choices").append(themeChoice());
  const parts = sections.map((section, n) => [section.name, sectionOf(section, `section-${n + 1}`, title)]);
  const runs = sections.filter(({ kind, groups }) => kind === "run" && groups.totals);
  if (runs.length > 1) {
    const compared = element("section", { id: "compared", "aria-labelledby": "compared-title" }, element("h2", { id: "compared-title" }, "Runs compared"), comparedSection(runs));
    parts.unshift(["Runs compared", compared]);
  }
  if (parts.length > 1) {
    document.querySelector("nav").append(element("ul", {}, parts.map(([name, section]) => element("li", {}, element("a", { href: `#${section.id}` }, name)))));
  }
  document.querySelector("main").append(...parts.map(([, section]) => section));
  document.body.dataset.ready = "true";
}

build(readReport());
