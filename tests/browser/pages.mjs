// SPDX-License-Identifier: MIT
// node pages.mjs DELF FOLDER: makes the pages of six scenes in FOLDER, opens them in headless Chromium, dark and light,
// wide and narrow, and has axe-core look for what keeps people from reading them. Screenshots are left in FOLDER.
// node pages.mjs SITE FOLDER FILE …: the same of files of the folder SITE.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const [program, folder] = process.argv.slice(2, 4).map((path) => resolve(path));
const named = process.argv.slice(4), from = named.length ? program : folder;
const skip = (why) => { console.log(`skipped: ${why}; run tools/setup --browser`); process.exit(0); };

const browser = ["chromium", "chromium-browser", "google-chrome"].find((name) => spawnSync(name, ["--version"]).status === 0);
if (!browser) skip("there is no Chromium");
let axe;
try { axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8"); } catch { skip("there is no axe-core"); }

// Pages by name, with the words of the program that make each and the exit code that it ends with.
const pages = {
  collision: ["run collision"],
  sphere: ["run sphere"],
  bounce: ["run soliton-bounce"],
  kdv: ["run kdv --run.until=0.5"],
  pendulum: ["run pendulum"],
  fault: ["verify collision --run.until=10 --verify.fault=sign", 1],
  sweep: ["sweep collision --lattice.courant=0.125:0.5:0.125 --run.until=20"],
};
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
for (const [name, [words, code = 0]] of named.length ? [] : Object.entries(pages)) {
  const ran = spawnSync(program, [...words.split(" "), "--output.report=on", "--out", name], { cwd: folder, encoding: "utf8" });
  if (ran.status !== code) throw new Error(`delf ${words}: exit code ${ran.status}: ${ran.stderr}`);
}
if (!named.length) execFileSync(program, ["report", "collision", "sphere", "--out", "beside.html"], { cwd: folder });
const files = named.length ? named : [...Object.keys(pages).map((name) => join(name, "report.html")), "beside.html"];

// The check can fail: an image without words, text that is hard to read, a list that is none.
writeFileSync(join(from, "broken.html"), '<html><body><img src="data:,"><p style="color:#aaa;background:#fff">faint</p></body></html>');

// Chromium's own protocol, by a pipe: messages of JSON that end in a zero byte.
const chromium = spawn(browser, ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
  "--remote-debugging-pipe", "--hide-scrollbars", `--user-data-dir=${join(folder, "profile")}`, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
const waiting = new Map(), events = [];
let number = 0, rest = "";
chromium.stdio[4].on("data", (data) => {
  const parts = (rest + data).split("\0");
  rest = parts.pop();
  for (const message of parts.map((part) => JSON.parse(part)))
    if (message.id) waiting.get(message.id)(message);
    else events.push(message);
});
let started = false;
const silent = () => { if (!started) { console.log("skipped: Chromium does not start here"); process.exit(0); } };
chromium.on("exit", () => { silent(); if (waiting.size) { console.error("Chromium ended"); process.exit(1); } });
for (const part of [chromium, chromium.stdio[3]]) part.on("error", silent);
const ask = (method, params = {}, sessionId = undefined) => new Promise((done, failed) => {
  waiting.set(++number, (m) => { waiting.delete(m.id); m.error ? failed(new Error(`${method}: ${m.error.message}`)) : done(m.result); });
  chromium.stdio[3].write(JSON.stringify({ id: number, method, params, sessionId }) + "\0");
});
setTimeout(silent, 60000).unref();
await ask("Browser.getVersion");
started = true;
const event = async (name, sessionId) => {
  for (let n = 0; n < 600; ++n) {
    const at = events.findIndex((m) => m.method === name && m.sessionId === sessionId);
    if (at >= 0) return events.splice(at, 1)[0];
    await new Promise((go) => setTimeout(go, 50));
  }
  throw new Error(`no ${name} in 30 s`);
};

async function violations(file, width, colours) {
  const { targetId } = await ask("Target.createTarget", { url: "about:blank" });
  const { sessionId } = await ask("Target.attachToTarget", { targetId, flatten: true });
  const tell = (method, params) => ask(method, params, sessionId);
  await tell("Page.enable");
  await tell("Runtime.enable");
  await tell("Log.enable");
  await tell("Emulation.setDeviceMetricsOverride", { width, height: 900, deviceScaleFactor: 1, mobile: width < 600 });
  await tell("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: colours }] });
  await tell("Page.navigate", { url: `file://${join(from, file)}` });
  await event("Page.loadEventFired", sessionId);
  const evaluate = async (expression) => {
    const { result, exceptionDetails } = await tell("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  };
  const found = events.filter((m) => m.sessionId === sessionId && m.method === "Log.entryAdded").map((m) => m.params.entry.text);
  found.push(...await evaluate(`[
    ...[...document.images].filter((i) => !(i.complete && i.naturalWidth > 0)).map((i) => "an image is not drawn: " + i.alt),
    ...(document.documentElement.scrollWidth > innerWidth + 1 ? ["it is wider than the screen: " + document.documentElement.scrollWidth] : [])]`));
  await evaluate(axe + ";0");  // by the protocol: the page itself has no script, and its policy allows none
  found.push(...await evaluate(`axe.run(document).then((r) => r.violations.map((v) => v.id + ": " + v.help + ": " + v.nodes[0].html.slice(0, 120)))`));
  const name = `${file.replace("/report.html", "").replace(".html", "").replaceAll("/", "-")}-${width}-${colours}`;
  const { cssContentSize } = await tell("Page.getLayoutMetrics");
  const { data } = await tell("Page.captureScreenshot", { captureBeyondViewport: true,
    clip: { x: 0, y: 0, width, height: Math.min(cssContentSize.height, 12000), scale: 1 } });
  writeFileSync(join(folder, `${name}.png`), Buffer.from(data, "base64"));
  await evaluate("localStorage.clear()");  // colours that a page remembers are those of the next one
  await ask("Target.closeTarget", { targetId });
  return found;
}

let wrong = 0;
for (const file of files)
  for (const [width, colours] of [[1280, "light"], [400, "light"], [1280, "dark"]]) {
    const found = await violations(file, width, colours);
    wrong += found.length;
    console.log(`${file}, ${statSync(join(from, file)).size} bytes, ${width} ${colours}: ${found.length || "no"} violation${found.length === 1 ? "" : "s"}`);
    for (const one of found) console.log(`  ${one}`);
  }
if ((await violations("broken.html", 1280, "light")).length < 3) { console.error("the check finds nothing in a broken page"); ++wrong; }
await ask("Browser.close").catch(() => {});
process.exit(wrong ? 1 : 0);
