// The data of the page: one JSON block, and a block of base64 for each array it refers to.

const views = { f64: Float64Array, f32: Float32Array, u16: Uint16Array, i16: Int16Array };
const decoded = new Map();

/** The object in the page's JSON block. */
export function readReport() {
  return JSON.parse(document.getElementById("data").textContent);
}

/** The numbers of an array, decoded when they are first asked for. */
export function numbers(reference) {
  let values = decoded.get(reference.array);
  if (!values) {
    values = decode(reference);
    decoded.set(reference.array, values);
  }
  return values;
}

/** The same, without keeping them: for frames, of which one at a time is shown. */
export function decode(reference) {
  const text = document.getElementById(`array-${reference.array}`).textContent;
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new views[reference.type](bytes.buffer);
}

function product(shape) {
  return shape.reduce((a, b) => a * b, 1);
}

/** Row `row` of a dataset that has one for each sample; all of one that is constant. */
export function rowOf(dataset, row) {
  const values = numbers(dataset);
  if (!dataset.has_rows) return values;
  const size = product(dataset.shape.slice(1));
  return values.subarray(row * size, (row + 1) * size);
}

/** One component of each row: column(dataset, 2) is the third of each. */
export function column(dataset, component = 0) {
  const values = numbers(dataset);
  const size = product(dataset.shape.slice(1));
  return Float64Array.from({ length: dataset.shape[0] }, (_, row) => values[row * size + component]);
}
