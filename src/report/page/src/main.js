// The page: a heading, a section for each file, and the licences of the libraries.
import { element, shownOrFailed } from "./dom.js";
import { readReport } from "./data.js";
import { themeChoice } from "./theme.js";
import { runSection } from "./sections/run.js";
import { sweepSection } from "./sections/sweep.js";
import { benchSection, benchTitle } from "./sections/bench.js";
import { comparedSection } from "./sections/compared.js";

const kinds = {
  run: { word: "Run", make: runSection, titleOf: (run) => run.parameters.title?.value },
  sweep: { word: "Sweep", make: sweepSection, titleOf: () => undefined },
  bench: { word: "Benchmark", make: benchSection, titleOf: benchTitle },
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

function sectionOf(section, title, id) {
  const { word, make } = kinds[section.kind];
  return element(
    "section",
    { id, "aria-labelledby": `${id}-title` },
    element("h2", { id: `${id}-title` }, title),
    element("p", { class: "source" }, `${word}, ${section.file}`),
    shownOrFailed(section.name, () => make(section)),
  );
}

// Files of one title are told apart by their names.
function titlesOf(sections) {
  const titles = sections.map((section) => kinds[section.kind].titleOf(section) || section.name);
  return titles.map((title, n) => (titles.filter((other) => other === title).length > 1 ? `${title}: ${sections[n].name}` : title));
}

function build(report) {
  const { sections } = report;
  nameSections(sections);
  const titles = titlesOf(sections);
  const title = report.title || (sections.length === 1 ? titles[0] : "Results");
  document.title = `${title} – Needlework`;
  document.querySelector("h1").textContent = title;
  document.getElementById("made-by").textContent = `needlework report, version ${report.version}`;
  document.getElementById("choices").append(themeChoice());
  const parts = sections.map((section, n) => [titles[n], sectionOf(section, titles[n], `section-${n + 1}`)]);
  const runs = sections.filter(({ kind, groups }) => kind === "run" && groups.totals);
  if (runs.length > 1) {
    const compared = element("section", { id: "compared", "aria-labelledby": "compared-title" }, element("h2", { id: "compared-title" }, "Runs compared"), shownOrFailed("The comparison", () => comparedSection(runs)));
    parts.unshift(["Runs compared", compared]);
  }
  if (parts.length > 1) {
    document.querySelector("nav").append(element("ul", {}, parts.map(([name, section]) => element("li", {}, element("a", { href: `#${section.id}` }, name)))));
  }
  document.querySelector("main").append(...parts.map(([, section]) => section));
  // A heading that repeats the title of the page is for those who jump from heading to heading.
  if (parts.length === 1 && titles[0] === title) parts[0][1].querySelector("h2").className = "spoken";
  document.body.dataset.ready = "true";
}

build(readReport());
