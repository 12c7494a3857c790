// Elements of the page.

/** Makes an element. Attributes that are functions listen to the event of that name; those that are
 * false or undefined are left out. Children are elements or texts, never markup; those that are null,
 * undefined or false are left out. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value);
    else if (value !== false && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return made;
}

/** The elements that `make` makes; where it fails, a line that says so in their place, so that all
 * others are shown. */
export function shownOrFailed(what, make) {
  try {
    return [make()].flat();
  } catch (error) {
    console.error(error);
    return [element("p", { class: "failed", role: "alert" }, `${what} cannot be shown: ${error.message}`)];
  }
}

let count = 0;

/** An id that no other element has. */
export function freshId(word) {
  count += 1;
  return `${word}-${count}`;
}

/** A button that is pressed or not. */
export function toggle(label, pressed, onChange) {
  const button = element("button", { type: "button", "aria-pressed": String(pressed) }, label);
  button.addEventListener("click", () => {
    const now = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", String(now));
    onChange(now);
  });
  return button;
}

/** A labelled select of [value, text] pairs. */
export function choice(label, options, value, onChange) {
  const select = element(
    "select",
    { change: () => onChange(select.value) },
    options.map(([word, text]) => element("option", { value: word }, text)),
  );
  select.value = value;
  return element("label", { class: "choice" }, element("span", {}, label), select);
}

/** A labelled slider over 0 to most, with a text beside it that says what its value means. */
export function slider(label, most, value, textOf, onChange) {
  const output = element("output", {}, textOf(value));
  const input = element("input", { type: "range", min: 0, max: most, step: 1 });
  input.value = value;
  const show = () => {
    output.textContent = textOf(Number(input.value));
    input.setAttribute("aria-valuetext", output.textContent);
  };
  show();
  input.addEventListener("input", () => {
    show();
    onChange(Number(input.value));
  });
  const made = element("label", { class: "slider" }, element("span", {}, label), input, output);
  made.set = (now) => {
    input.value = now;
    show();
  };
  return made;
}

/** Calls `draw(width)` when the element has a width, and whenever it has changed. Returns what draws
 * again. Asking for the width of one element after drawing another would lay out the page each time,
 * so the observer says it. */
export function onWidth(target, draw) {
  let last = 0;
  new ResizeObserver(([{ contentRect }]) => {
    const width = Math.round(contentRect.width);
    if (width === 0 || width === last) return;
    last = width;
    draw(width);
  }).observe(target);
  return () => {
    if (last > 0) draw(last);
  };
}

/** Calls `action` once, when the element is about to be seen, or printed. */
export function whenNear(target, action) {
  const observer = new IntersectionObserver((entries) => {
    if (entries.some((entry) => entry.isIntersecting)) start();
  }, { rootMargin: "300px" });
  const start = () => {
    observer.disconnect();
    window.removeEventListener("beforeprint", start);
    action();
  };
  observer.observe(target);
  window.addEventListener("beforeprint", start);
}
