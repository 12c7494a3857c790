// What all charts have: a heading, what is drawn, a caption, and the table behind it.
import { element, freshId } from "../dom.js";
import { tableBehind } from "./table.js";

/** `columns()` makes the columns of the table. Notes say what was left out. */
export function figureOf({ title, caption, notes = [], wide = false }, { tools = [], body, columns }) {
  const id = freshId("chart");
  const table = tableBehind(title, columns);
  const made = element(
    "figure",
    { class: wide ? "chart wide" : "chart", "aria-labelledby": id },
    element("div", { class: "head" }, element("h4", { id }, title), element("div", { class: "tools" }, tools)),
    body,
    element(
      "figcaption",
      {},
      caption,
      notes.map((note) => element("span", { class: "note" }, " ", note)),
    ),
    table,
  );
  made.refreshTable = table.refresh;
  return made;
}
