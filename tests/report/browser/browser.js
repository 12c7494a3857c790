// Pages in Chromium, drawn by the CPU, with all that the browser complains about.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const folder = mkdtempSync(path.join(tmpdir(), "needlework-report-"));

/** Runs the program in the folder and returns what it prints. */
export function needlework(...words) {
  return execFileSync(process.env.NEEDLEWORK_PROGRAM, words, { cwd: folder, encoding: "utf8" });
}

export function write(name, text) {
  writeFileSync(path.join(folder, name), text);
}

export function readPage(name) {
  return readFileSync(path.join(folder, name), "utf8");
}

export function launch() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
  });
}

/** Opens a page from disk, after running `first` in it. `complaints`: errors, warnings of the console, and requests for anything
 * but the file itself. */
export async function open(browser, name, options = {}, first = () => {}) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 900 }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  await page.addInitScript(first);
  const complaints = [];
  page.on("console", (message) => {
    // Reading pixels back is what tests do, not the page.
    if (["error", "warning"].includes(message.type()) && !message.text().includes("ReadPixels")) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`request ${request.url()}`);
  });
  await page.goto(pathToFileURL(path.join(folder, name)).href);
  await page.waitForSelector("body[data-ready]");
  return { page, complaints, close: () => context.close() };
}

export function cleanUp() {
  rmSync(folder, { recursive: true, force: true });
}
