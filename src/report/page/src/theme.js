// Dark or light: as the system has it, unless the reader of the page chooses.
import { choice } from "./dom.js";

const system = matchMedia("(prefers-color-scheme: dark)");
const listeners = [];

/** Calls `action` whenever the colours have changed. */
export function onTheme(action) {
  listeners.push(action);
}

/** The present value of a variable of the style sheet. */
export function colourOfTheme(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name);
}

function changed() {
  for (const action of listeners) action();
}

// Paper is light.
let beforePrint;
window.addEventListener("beforeprint", () => {
  beforePrint = document.documentElement.dataset.theme;
  setTheme("light");
});
window.addEventListener("afterprint", () => setTheme(beforePrint));

function setTheme(name) {
  if (name === undefined || name === "system") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = name;
  changed();
}

/** The choice between the themes. */
export function themeChoice() {
  const options = [["system", "as the system"], ["light", "light"], ["dark", "dark"]];
  system.addEventListener("change", changed);
  return choice("Colours", options, "system", setTheme);
}
