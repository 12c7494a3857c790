// The table behind a chart: what is drawn, as numbers.
import { element } from "../dom.js";
import { numberText } from "../numbers.js";

const rowsOfPage = 200;

/** `columns`: {name, values} of equal lengths. Made when it is opened, and long ones in pages. */
export function tableBehind(title, makeColumns) {
  const details = element("details", { class: "behind" }, element("summary", {}, "Table"));
  let shown = null;
  const show = () => {
    shown?.remove();
    shown = tableOf(title, makeColumns());
    details.append(shown);
  };
  details.addEventListener("toggle", () => {
    if (details.open) show();
  });
  details.refresh = () => {
    if (details.open) show();
  };
  return details;
}

function tableOf(title, columns) {
  const length = Math.max(0, ...columns.map((column) => column.values.length));
  const body = element("tbody");
  const position = element("span", { "aria-live": "polite" });
  let first = 0;
  const fill = () => {
    body.replaceChildren(
      ...Array.from({ length: Math.min(rowsOfPage, length - first) }, (_, n) =>
        element("tr", {}, columns.map((column) => element("td", {}, cellText(column.values[first + n])))),
      ),
    );
    const last = Math.min(first + rowsOfPage, length);
    position.textContent = length > rowsOfPage ? `Rows ${first + 1} to ${last} of ${length}` : `${length} rows`;
  };
  const turn = (by) => {
    first = Math.min(Math.max(0, first + by * rowsOfPage), Math.floor((length - 1) / rowsOfPage) * rowsOfPage);
    fill();
  };
  fill();
  const pages =
    length > rowsOfPage
      ? [
          element("button", { type: "button", click: () => turn(-1) }, "Previous rows"),
          element("button", { type: "button", click: () => turn(1) }, "Next rows"),
        ]
      : [];
  return element(
    "div",
    { class: "table" },
    element("div", { class: "tools" }, position, ...pages, csvLink(title, columns, length)),
    element(
      "div",
      { class: "scroll", tabindex: 0, role: "region", "aria-label": `Table: ${title}` },
      element(
        "table",
        {},
        element("caption", {}, title),
        element("thead", {}, element("tr", {}, columns.map((c) => element("th", { scope: "col" }, c.name)))),
        body,
      ),
    ),
  );
}

function cellText(value) {
  return typeof value === "string" ? value : numberText(value, 6);
}

function csvLink(title, columns, length) {
  const name = `${title.toLowerCase().replace(/[^a-z0-9]+/g, "-")}.csv`;
  const link = element("a", { href: "#", download: name }, "Save as CSV");
  link.addEventListener("click", () => {
    link.href = URL.createObjectURL(new Blob([csvText(columns, length)], { type: "text/csv" }));
  });
  return link;
}

/** All rows, with all digits. */
export function csvText(columns, length) {
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const lines = [columns.map((column) => quoted(column.name)).join(",")];
  for (let row = 0; row < length; ++row) {
    lines.push(columns.map((column) => quoted(String(column.values[row] ?? ""))).join(","));
  }
  return lines.join("\n") + "\n";
}
