// The page in Chromium: on scenes from formulas, and on the pages whose paths are in HANGPOSE_PAGES, separated by ":",
// which hangpose wrote. Chromium is that of CHROMIUM, else the one in the PATH.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdir, mkdtemp, readFile, readdir, rm, stat, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";
import { halfway, matrixOf, motionOf } from "./oracle.js";
import { empty, page as written, pose, published, scene, sceneOf } from "./scene.js";

const PICTURES = fileURLToPath(new URL("../../build/view/", import.meta.url));
const GIVEN = (process.env.HANGPOSE_PAGES ?? "").split(":").filter(Boolean);
const CHROMIUM =
  process.env.CHROMIUM ??
  execFileSync("sh", ["-c", "command -v chromium || command -v chromium-browser || command -v google-chrome"])
    .toString()
    .trim();
/** Largest difference of an entry of a matrix: the page computes in double precision from the same numbers. */
const EXACT = 1e-6;

let browser;
let folder;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "hangpose-view-"));
  await mkdir(PICTURES, { recursive: true });
  browser = await puppeteer.launch({
    executablePath: CHROMIUM,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-color-profile=srgb"],
  });
});

after(async () => {
  await browser?.close();
  await rm(folder, { recursive: true, force: true });
});

/** Opens a page. Errors of the page, other than the one that is meant, and requests that it makes fail the test. */
async function open(
  t,
  html,
  { width = 1000, height = 640, scale = 1, scheme = "light", prepare = null, meant = null } = {},
) {
  const file = join(folder, `${t.name.replace(/\W+/g, "_")}_${Math.random().toString(36).slice(2)}.html`);
  await writeFile(file, html);
  const page = await browser.newPage();
  const [errors, requests] = [[], []];
  page.on("console", (message) => ["error", "warn"].includes(message.type()) && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  await page.setViewport({ width, height, deviceScaleFactor: scale });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  if (prepare) await page.evaluateOnNewDocument(prepare);
  await page.goto(pathToFileURL(file).href);
  t.after(async () => {
    await page.close();
    assert.deepEqual(
      errors.filter((error) => !meant?.test(error)),
      [],
      "errors in the console",
    );
    const made = requests.filter((url) => !/^(data|blob|about):/.test(url));
    assert.deepEqual(made, [pathToFileURL(file).href], "requests");
  });
  return page;
}

const ready = (page) => page.evaluate(() => window.hangpose.ready);
const state = (page) => page.evaluate(() => window.hangpose.state());
const drawn = (page) =>
  page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve()))));

function near(got, wanted, what) {
  const worst = Math.max(...wanted.map((value, i) => Math.abs(value - got[i])));
  assert.ok(worst < EXACT, `${what}: differs by ${worst}`);
}

/** Counts the pixels of the picture that look like the object, and all different colours. */
function look(page) {
  return page.evaluate(async () => {
    const image = await createImageBitmap(await window.hangpose.picture());
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const colours = new Set();
    let [orange, x, y] = [0, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      colours.add((r << 16) | (g << 8) | b);
      if (r > 1.35 * g && g > 1.2 * b && r > 60) {
        orange++;
        x += (i / 4) % image.width;
        y += Math.floor(i / 4 / image.width);
      }
    }
    return {
      colours: colours.size,
      orange: orange / (data.length / 4),
      x: x / orange / image.width,
      y: y / orange / image.height,
    };
  });
}

/** Everything that must hold for any page that hangpose writes; the oracle is the JSON in it. */
async function checkWhole(t, html) {
  const data = sceneOf(html);
  const page = await open(t, html);
  await ready(page);
  const { webgl } = await state(page);
  assert.equal(webgl, true);
  const title = await page.title();
  assert.equal(title, `${data.object.name} on ${data.supporter.name}`);

  await t.test("the picture shows the object", async () => {
    const { colours, orange } = await look(page);
    assert.ok(colours > 200, `${colours} colours`);
    assert.ok(orange > 0.005, `${(100 * orange).toFixed(1)} % of the picture is the object`);
  });

  if (data.poses.length === 0) {
    await t.test("the reason is given", async () => {
      const text = await page.evaluate(() => document.querySelector("#details").innerText);
      assert.match(text, /Nothing hangs/);
      assert.ok(text.toLowerCase().includes(data.rejection.reason.toLowerCase()), text);
      assert.equal((await state(page)).pose, null);
    });
  }

  await t.test("keys step through the poses, and each is where the data says", async () => {
    for (const [i, pose] of data.poses.slice(0, 12).entries()) {
      if (i > 0) await page.keyboard.press(i % 2 ? "j" : "ArrowDown");
      const now = await state(page);
      assert.equal(now.pose, i);
      near(now.matrix, matrixOf(pose.rest ?? pose.release), `pose ${i}`);
      const shown = await page.evaluate(() => document.querySelector("#items [aria-current]").innerText);
      assert.match(shown, new RegExp(`^\\s*${pose.rank}\\b`));
    }
    await page.evaluate((most) => most > 0 && window.hangpose.select(0), data.poses.length);
    await page.keyboard.press("k");
    assert.equal((await state(page)).pose, data.poses.length > 0 ? 0 : null);
  });

  const moving = data.poses.findIndex((pose) => pose.motion && motionOf(pose.motion).length > 1);
  if (moving >= 0) {
    await t.test("the release plays from the release pose to the rest pose", async () => {
      const chosen = data.poses[moving];
      const frames = motionOf(chosen.motion);
      await page.evaluate((i) => {
        window.hangpose.select(i);
        window.hangpose.show("release");
        window.hangpose.seek(0);
      }, moving);
      near((await state(page)).matrix, matrixOf(frames[0]), "first frame");
      const between = Math.floor(frames.length / 2);
      const [a, b] = [frames[between - 1], frames[between]];
      await page.evaluate((seconds) => window.hangpose.seek(seconds), (a.seconds + b.seconds) / 2);
      near((await state(page)).matrix, halfway(a, b, data.object.centre_of_mass), "between two frames");
      await page.evaluate(() => window.hangpose.seek(0));
      const times = await page.evaluate(async () => {
        document.querySelector("#speed").value = "2";
        const seen = [];
        const done = window.hangpose.play().then(() => seen.push("end"));
        const watch = () => {
          seen.push(window.hangpose.state().seconds);
          if (window.hangpose.state().playing) requestAnimationFrame(watch);
        };
        watch();
        await done;
        return seen.filter((time) => time !== "end");
      });
      assert.ok(
        times.every((time, i) => i === 0 || time >= times[i - 1]),
        "time goes on",
      );
      const end = await state(page);
      assert.equal(end.playing, false);
      assert.equal(end.seconds, end.duration);
      near(end.matrix, matrixOf(chosen.rest), "rest pose");
    });
  }

  const reached = data.poses.findIndex((pose) => pose.path);
  if (reached >= 0) {
    await t.test("the slider moves the object along the path", async () => {
      const { path, release, rest } = data.poses[reached];
      await page.evaluate((i) => window.hangpose.select(i), reached);
      await page.keyboard.press("p");
      const whole = await state(page);
      assert.equal(whole.sequence, "path");
      const slide = (share) =>
        page.evaluate((value) => {
          const slider = document.querySelector("#time");
          slider.value = String(value);
          slider.dispatchEvent(new Event("input", { bubbles: true }));
        }, 1000 * share);
      const { waypoints } = path;
      await slide(0);
      near((await state(page)).matrix, matrixOf(waypoints[0]), "start");
      await slide(1);
      near((await state(page)).matrix, matrixOf(waypoints[waypoints.length - 1]), "end");
      // What is before the first waypoint is the gripper's approach, when the object is taken off.
      const shift = Math.max(0, whole.duration - Math.max(...waypoints.map((w) => w.seconds)));
      const takesOff =
        Math.hypot(...rest.position.map((p, i) => p - waypoints[0].position[i])) <
        Math.hypot(...rest.position.map((p, i) => p - waypoints[waypoints.length - 1].position[i]));
      await page.evaluate(
        (seconds) => window.hangpose.seek(seconds),
        waypoints[path.release].seconds + (takesOff ? shift : 0),
      );
      near((await state(page)).matrix, matrixOf(waypoints[path.release]), "release pose");
      near(
        matrixOf(waypoints[path.release]).map((v, i) => v - matrixOf(release)[i]),
        Array(16).fill(0),
        "the path leads to the release pose",
      );
      const middle = Math.max(1, Math.floor(waypoints.length / 2));
      const [a, b] = [waypoints[middle - 1], waypoints[middle]];
      await page.evaluate(
        (seconds) => window.hangpose.seek(seconds),
        (a.seconds + b.seconds) / 2 + (takesOff ? shift : 0),
      );
      near((await state(page)).matrix, halfway(a, b, data.object.centre_of_mass), "between two waypoints");
      if (data.gripper && path.gripper.length > 0 && !takesOff) {
        await page.evaluate(() => window.hangpose.seek(0));
        const start = await state(page);
        assert.equal(start.gripper.opening, 0);
        near(start.gripper.matrix, matrixOf(waypoints[0]), "the gripper holds the object");
        await page.evaluate(() => window.hangpose.seek(window.hangpose.state().duration));
        const end = await state(page);
        assert.equal(end.gripper.opening, 1);
        near(end.gripper.matrix, matrixOf(path.gripper[path.gripper.length - 1]), "the gripper has left");
        near(end.matrix, matrixOf(rest), "the object stays");
      }
      await page.evaluate(() => window.hangpose.show("release"));
    });
  }

  if (data.fallen.length > 0) {
    await t.test("what fell can be chosen, and shows how", async () => {
      const [one] = data.fallen;
      await page.evaluate(() => window.hangpose.selectFallen(0));
      const now = await state(page);
      assert.deepEqual([now.list, now.fallen, now.pose, now.layers.fallen], ["fallen", 0, null, true]);
      near(now.matrix, matrixOf(one.release), "release");
      const frames = motionOf(one.motion);
      await page.evaluate(() => window.hangpose.seek(Infinity));
      near((await state(page)).matrix, matrixOf(frames.at(-1) ?? one.release), "end of the fall");
      await page.keyboard.press("c");
      assert.equal((await state(page)).list, "poses");
    });
  }

  await t.test("360 pixels wide: nothing is wider than the page", async () => {
    await page.setViewport({ width: 360, height: 740, deviceScaleFactor: 1 });
    await page.evaluate(() => document.querySelectorAll("details").forEach((one) => (one.open = true)));
    await drawn(page);
    const wide = await page.evaluate(() => [
      document.documentElement.scrollWidth,
      ...[...document.querySelectorAll("#details, #items, #bar, #transport")].map((e) => e.scrollWidth),
    ]);
    assert.ok(Math.max(...wide) <= 360, String(wide));
  });
  return page;
}

describe("whole pages", () => {
  test("a scene with everything", async (t) => {
    const data = scene();
    await checkWhole(t, await written(data, `${data.object.name} on ${data.supporter.name}`));
  });
  test("nothing hangs, and every array is empty", async (t) => {
    const data = empty();
    await checkWhole(t, await written(data, `${data.object.name} on ${data.supporter.name}`));
  });
  test("the published method, of which much is null", async (t) => {
    const data = published();
    const page = await checkWhole(t, await written(data, `${data.object.name} on ${data.supporter.name}`));
    const text = await page.evaluate(() => document.querySelector("#details").innerText);
    assert.doesNotMatch(text, /NaN|undefined|null/);
  });
  for (const path of GIVEN) {
    test(`a page that hangpose wrote: ${basename(path)}`, async (t) => checkWhole(t, await readFile(path, "utf8")));
  }
});

test("30 000 triangles, 30 000 points and 200 poses", async (t) => {
  const html = await written(scene({ fallen: [] }, { around: 250, across: 60, points: 30000, poses: 200 }), "large");
  assert.ok(html.length < 5e6, `${html.length} bytes`);
  const page = await open(t, html);
  await ready(page);
  for (let i = 0; i < 30; i++) await page.keyboard.press("j");
  const now = await state(page);
  assert.equal(now.pose, 30);
  near(now.matrix, matrixOf(pose(30).rest), "pose 30");
  const inSight = await page.evaluate(() => {
    const [list, item] = ["#items", "#items [aria-current]"].map((s) =>
      document.querySelector(s).getBoundingClientRect(),
    );
    return item.top >= list.top - 1 && item.bottom <= list.bottom + 1;
  });
  assert.ok(inSight, "the chosen pose is scrolled into sight");
  await page.evaluate(() => window.hangpose.select(199));
  await assert.rejects(
    page.evaluate(() => window.hangpose.select(200)),
    /there are 200 poses/,
  );
  assert.ok((await look(page)).orange > 0.005);
});

test("keys, buttons and themes", async (t) => {
  const page = await open(t, await written(scene(), "keys"), { width: 1280, height: 800 });
  await ready(page);
  await page.keyboard.press("?");
  assert.equal((await state(page)).help, true);
  await page.keyboard.press("j");
  assert.equal((await state(page)).pose, 0, "keys do nothing behind the help");
  await page.keyboard.press("Escape");
  assert.equal((await state(page)).help, false);
  await page.keyboard.press("Home");
  assert.equal((await state(page)).seconds, 0);
  await page.keyboard.press("ArrowRight");
  const { seconds, duration } = await state(page);
  assert.ok(seconds > 0 && seconds < 0.1 * duration);
  await page.keyboard.press("End");
  await page.select("#speed", "0.1");
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("Space");
  assert.equal((await state(page)).playing, true);
  await page.keyboard.press("Space");
  assert.equal((await state(page)).playing, false);
  await page.click("#items li:nth-child(3) button");
  assert.equal((await state(page)).pose, 2);
  await page.click("#tab-fallen");
  assert.equal((await state(page)).list, "fallen");
  await page.click('[data-layer="samples"]');
  assert.equal((await state(page)).layers.samples, true);
  const lens = await look(page);
  await page.click('[data-layer="object"]');
  assert.ok((await look(page)).orange < 0.5 * lens.orange, "the layer of the object is off");
  await page.evaluate(() => window.hangpose.setLayer("object", true));

  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await background();
  await page.keyboard.press("t");
  assert.equal((await state(page)).theme, "dark");
  assert.notEqual(await background(), light);
  await page.keyboard.press("t");
  assert.equal((await state(page)).theme, "light");
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  await drawn(page);
  assert.equal((await state(page)).theme, "dark", "the page follows the system");
});

test("text is legible in both themes, and every control has a name", async (t) => {
  const page = await open(t, await written(scene(), "names"));
  await ready(page);
  await page.evaluate(() => window.hangpose.select(1));
  for (const theme of ["light", "dark"]) {
    const low = await page.evaluate((name) => {
      window.hangpose.setTheme(name);
      const numbers = (colour) =>
        /\(([^)]*)\)/
          .exec(colour)[1]
          .split(/[\s,/]+/)
          .filter(Boolean)
          .map(Number);
      const luminance = (rgb) =>
        rgb
          .map((v) => v / 255)
          .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
          .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
      const behind = (element) => {
        for (let at = element; at; at = at.parentElement) {
          const colour = getComputedStyle(at).backgroundColor;
          if (colour.startsWith("rgb(")) return numbers(colour);
        }
        return [255, 255, 255];
      };
      const bad = [];
      for (const element of document.querySelectorAll("#bar *, #list *, #details *, #transport *")) {
        const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
        if (!own || element.closest(":disabled") || element.namespaceURI.endsWith("svg")) continue;
        const [a, b] = [
          luminance(numbers(getComputedStyle(element).color).slice(0, 3)),
          luminance(behind(element)),
        ].sort((x, y) => y - x);
        if ((a + 0.05) / (b + 0.05) < 4.5)
          bad.push(
            `${element.tagName}.${element.className} ${element.textContent} ${((a + 0.05) / (b + 0.05)).toFixed(2)}`,
          );
      }
      return bad;
    }, theme);
    assert.deepEqual(low, [], theme);
  }
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, input, select, summary, canvas, svg.rose")]
      .filter((e) => !(e.getAttribute("aria-label") || e.innerText?.trim() || e.closest("label")?.textContent.trim()))
      .map((e) => e.outerHTML),
  );
  assert.deepEqual(nameless, []);
});

test("a picture is saved", async (t) => {
  const page = await open(t, await written(scene(), "save"));
  await ready(page);
  const session = await page.createCDPSession();
  const into = await mkdtemp(join(folder, "saved-"));
  await session.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: into });
  await page.keyboard.press("s");
  let files = [];
  for (let i = 0; i < 100 && !files.some((name) => name.endsWith(".png")); i++) {
    await new Promise((resolve) => setTimeout(resolve, 50));
    files = await readdir(into);
  }
  assert.deepEqual(files, ["hangpose_ring_b_amp_b__pose_1.png"]);
  const bytes = await readFile(join(into, files[0]));
  assert.equal(bytes.subarray(1, 4).toString(), "PNG");
  assert.ok(bytes.readUInt32BE(16) > 1000, "twice as wide as on the page");
});

test("without WebGL the page says so and keeps its tables", async (t) => {
  const page = await open(t, await written(scene(), "no picture"), {
    prepare: () => {
      const get = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith("webgl") ? null : get.call(this, kind, ...rest);
      };
      // three.js reports this as an error; the page reports it in words.
      console.error = () => {};
    },
  });
  await ready(page);
  assert.equal((await state(page)).webgl, false);
  assert.match(await page.evaluate(() => document.querySelector("#no-picture").innerText), /no WebGL/);
  await page.keyboard.press("j");
  const now = await state(page);
  assert.equal(now.pose, 1);
  near(now.matrix, matrixOf(pose(1).rest), "pose 1");
  assert.match(await page.evaluate(() => document.querySelector("#details").innerText), /Hooked/);
});

test("in a frame with srcdoc and without the rights of its origin, as in a notebook", async (t) => {
  const inside = await written(scene(), "frame");
  const attribute = inside.replaceAll("&", "&amp;").replaceAll('"', "&quot;");
  const page = await open(
    t,
    `<!doctype html><title>notebook</title><link rel="icon" href="data:,">
    <iframe sandbox="allow-scripts" width="900" height="600" srcdoc="${attribute}"></iframe>`,
  );
  const frame = await (await page.waitForSelector("iframe")).contentFrame();
  await frame.waitForFunction(() => window.hangpose?.state);
  await frame.evaluate(() => window.hangpose.ready);
  await frame.evaluate(() => window.hangpose.select(2));
  const now = await frame.evaluate(() => window.hangpose.state());
  near(now.matrix, matrixOf(pose(2).rest), "pose 2");
});

test("another up direction turns the camera", async (t) => {
  const data = scene();
  data.supporter.up = [0, -1, 0];
  const page = await open(t, await written(data, "up"));
  await ready(page);
  // Gravity points down on the screen.
  const [x, y] = await page.evaluate(() => {
    const line = document.querySelector("#triad line.axis-g");
    return [Number(line.getAttribute("x2")), Number(line.getAttribute("y2"))];
  });
  assert.ok(Math.abs(x) < 0.01 && y > 10, `${x} ${y}`);
});

test("a damaged scene is named", async (t) => {
  const cases = [
    [(s) => (s.schema = 2), /schema: is 2, but this page reads 1/],
    [(s) => (s.object.indices = "////////////////"), /object\.indices\[0\]: is 4294967295/],
    [(s) => (s.poses[1].margin.tilts = [1]), /poses\[1\]\.margin\.tilts: has 1 numbers, not 8/],
    [(s) => (s.supporter.normals = "AAAAAAAAAAAAAAAA"), /supporter: has 3000 points but 1 normals/],
    [(s) => (s.poses[0].path.release = 9), /poses\[0\]\.path\.release: is 9, but there are 4 waypoints/],
  ];
  for (const [damage, message] of cases) {
    const data = scene();
    damage(data);
    const page = await open(t, await written(data, "damaged"), { meant: message });
    await assert.rejects(ready(page), message);
    assert.match(await page.evaluate(() => document.body.innerText), message);
  }
});

test("pictures of the page: build/view", async (t) => {
  const html = GIVEN[0] ? await readFile(GIVEN[0], "utf8") : await written(scene(), "ring on rod.ply");
  for (const [name, options] of [
    ["light", { width: 1280, height: 800 }],
    ["dark", { width: 1280, height: 800, scheme: "dark" }],
    ["phone", { width: 360, height: 740, scale: 1.5 }],
  ]) {
    const page = await open(t, html, options);
    await ready(page);
    await drawn(page);
    const path = join(PICTURES, `view-${name}.png`);
    await page.screenshot({ path });
    assert.ok((await stat(path)).size > 10_000);
  }
});
