// The page: what is chosen, how it is shown, and what keys and buttons do.

import { Matrix4 } from "three";
import { fallOf, pathOf, releaseOf } from "./motion";
import type { Sequence } from "./motion";
import { fallHeight, fallenDetails, poseDetails, rejectionDetails } from "./details";
import { get, h } from "./dom";
import { count, percent, plural, seconds as inSeconds, millimetres } from "./format";
import { readScene } from "./scene";
import type { Fallen, HangingPose, Scene } from "./scene";
import { PALETTES } from "./theme";
import type { Theme } from "./theme";
import { drawTriad } from "./triad";
import { View } from "./view";
import { fateOf, kindOf } from "./words";

/** Step of the arrow keys in time: a share of the motion. */
const STEP = 0.02;
/** Shares of a motion at which the picture must show the object. */
const PLACES = [0, 0.25, 0.5, 0.75, 1];
/** Share of the picture's width up to which the object moves aside for the layers. */
const MOST_ROOM = 0.4;
/** Width from which the layers and the counts start open, pixels: that of three columns in style.css. */
const WIDE = 1100;

/** What the page shows. Matrices are row-major and map object to supporter coordinates. */
interface State {
  list: "poses" | "fallen";
  pose: number | null;
  fallen: number | null;
  sequence: "release" | "path" | "fall" | null;
  seconds: number;
  duration: number;
  playing: boolean;
  matrix: number[] | null;
  gripper: { matrix: number[]; opening: number } | null;
  phase: string | null;
  theme: Theme;
  layers: Record<string, boolean>;
  webgl: boolean;
  help: boolean;
}

function rows(matrix: Matrix4): number[] {
  return matrix.clone().transpose().toArray();
}

class Page {
  private list: "poses" | "fallen" = "poses";
  private readonly chosen = { poses: 0, fallen: 0 };
  private wanted: "release" | "path" = "release";
  private sequence: Sequence | null = null;
  private time = 0;
  private playing = false;
  private last = 0;
  private stopped: (() => void)[] = [];
  private theme: Theme;
  private view: View | null = null;
  private readonly items: Record<"poses" | "fallen", HTMLElement[]>;
  private readonly slider = get<HTMLInputElement>("time");
  private readonly system = window.matchMedia("(prefers-color-scheme: dark)");

  constructor(private readonly scene: Scene) {
    this.theme = this.system.matches ? "dark" : "light";
    this.items = { poses: this.poseItems(), fallen: this.fallenItems() };
    get("what").textContent = get("what").title = `${scene.object.name} on ${scene.supporter.name}`;
    this.fillSummary();
    this.tryView();
    this.fillLayers();
    this.bind();
    this.setTheme(this.theme);
    this.setList(scene.poses.length === 0 && scene.fallen.length > 0 && !scene.rejection ? "fallen" : "poses");
    this.fit();
  }

  private tryView(): void {
    try {
      this.view = new View(get("canvas"), this.scene);
    } catch (error) {
      console.info(`hangpose: no picture: ${(error as Error).message}`);
      get("canvas").replaceChildren();
      this.noPicture("This browser offers no WebGL 2, so there is no picture. The lists and figures are complete.");
      return;
    }
    const { canvas } = this.view;
    canvas.setAttribute("aria-label", `${this.scene.object.name} on ${this.scene.supporter.name} in three dimensions`);
    canvas.addEventListener("webglcontextlost", () =>
      this.noPicture("The browser has taken back the memory of the picture. Load the page again to see it."),
    );
    canvas.addEventListener("webglcontextrestored", () => {
      get("no-picture").hidden = true;
      this.view?.draw();
    });
    this.view.onDrawn = () => drawTriad(get("triad"), this.view!.camera, this.scene.supporter.up);
    get("scale").textContent = `Grid ${millimetres(this.view.gridCell).replace(".0", "")}`;
  }

  private noPicture(why: string): void {
    get("no-picture").textContent = why;
    get("no-picture").hidden = false;
    get("app").classList.toggle("no-picture", this.view === null);
  }

  // Lists.

  private item(list: "poses" | "fallen", index: number, ...content: (Node | string | null)[]): HTMLElement {
    const button = h("button", { type: "button" }, ...content);
    button.addEventListener("click", () => this.choose(list, index));
    return h("li", {}, button);
  }

  private poseItems(): HTMLElement[] {
    return this.scene.poses.map((pose, i) => {
      const kind = kindOf(pose.kind);
      const path = pose.path
        ? h("span", { class: "tag", title: "A path to this pose was planned" }, "path")
        : pose.pathFailure
          ? h("span", { class: "tag none", title: pose.pathFailure }, "no path")
          : null;
      const bar = h("span", { class: "bar", "aria-hidden": "true" });
      bar.style.setProperty("--share", String(pose.probability ?? 0));
      return this.item(
        "poses",
        i,
        h("span", { class: "rank" }, String(pose.rank)),
        h("span", { class: "kind" }, kind.name),
        path,
        h(
          "span",
          { class: "value", ...(pose.probability === null ? {} : { title: "Probability that it hangs and stays" }) },
          pose.probability === null ? "" : percent(pose.probability),
        ),
        pose.probability === null ? null : bar,
      );
    });
  }

  private fallenItems(): HTMLElement[] {
    return this.scene.fallen.map((fallen, i) => {
      const sequence = fallOf(fallen, this.scene);
      return this.item(
        "fallen",
        i,
        h("span", { class: "rank" }, String(i + 1)),
        h("span", { class: "kind" }, fateOf(fallen.fate).name),
        h(
          "span",
          { class: "value", title: "How far the centre of mass falls" },
          millimetres(fallHeight(sequence, this.scene)),
        ),
      );
    });
  }

  private fillSummary(): void {
    const { counts, seconds, rejection, poses, fallen, object, supporter } = this.scene;
    get("tab-poses").replaceChildren("Poses ", h("span", { class: "number" }, count(poses.length)));
    get("tab-fallen").replaceChildren("Fell ", h("span", { class: "number" }, count(fallen.length)));
    get<HTMLButtonElement>("tab-fallen").disabled = fallen.length === 0;
    const parts: HTMLElement[] = [];
    if (rejection && poses.length > 0) {
      parts.push(h("p", { class: "notice" }, h("strong", {}, "No room for more: "), rejection.reason));
    }
    const rowsOf: [string, string][] = [];
    if (counts && (counts.released > 0 || poses.every((pose) => pose.kind !== null))) {
      rowsOf.push(
        ["Released", count(counts.released)],
        ["Came to rest", count(counts.at_rest)],
        ["Rotated off", count(counts.rotated_off)],
        ["Slid off", count(counts.slid_off)],
        ["Still moving", count(counts.moving)],
      );
    }
    rowsOf.push(
      ["Object", plural(object.triangleCount, "triangle")],
      ["Supporter", plural(supporter.pointCount, "point")],
    );
    if (seconds) {
      rowsOf.push(["Time", inSeconds(seconds.object + seconds.supporter + seconds.matching)]);
    }
    const list = h("dl", {}, ...rowsOf.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
    if (seconds) {
      list.lastElementChild!.setAttribute(
        "title",
        `object ${inSeconds(seconds.object)}, supporter ${inSeconds(seconds.supporter)}, matching ` +
          `${inSeconds(seconds.matching)}`,
      );
    }
    parts.push(
      h(
        "details",
        { class: "counts", ...(window.innerWidth >= WIDE ? { open: "" } : {}) },
        h("summary", {}, "Prediction"),
        list,
        h("p", { class: "version" }, `hangpose ${this.scene.version}`),
      ),
    );
    get("summary").replaceChildren(...parts);
  }

  private fillLayers(): void {
    if (!this.view) {
      get("layers").hidden = true;
      return;
    }
    get("layer-list").replaceChildren(
      ...this.view.layers.map((layer) => {
        const box = h("input", { type: "checkbox", "data-layer": layer.id, ...(layer.on ? { checked: "" } : {}) });
        box.addEventListener("change", () => this.setLayer(layer.id, box.checked));
        const swatch = h("span", { class: "swatch", "aria-hidden": "true", "data-colour": layer.colour ?? layer.id });
        return h("label", {}, box, swatch, layer.label);
      }),
    );
    const layers = get<HTMLDetailsElement>("layers");
    layers.open = window.innerWidth >= WIDE;
    const makeRoom = () => {
      const room = layers.open ? layers.offsetWidth + layers.offsetLeft : 0;
      this.view?.keepFree(room < MOST_ROOM * get("canvas").clientWidth ? room : 0);
    };
    layers.addEventListener("toggle", makeRoom);
    new ResizeObserver(makeRoom).observe(get("canvas"));
    makeRoom();
  }

  private get pose(): HangingPose | null {
    return this.list === "poses" ? (this.scene.poses[this.chosen.poses] ?? null) : null;
  }

  private get fallen(): Fallen | null {
    return this.list === "fallen" ? (this.scene.fallen[this.chosen.fallen] ?? null) : null;
  }

  setList(list: "poses" | "fallen"): void {
    if (list === "fallen" && this.scene.fallen.length === 0) return;
    this.list = list;
    for (const name of ["poses", "fallen"] as const) {
      get(`tab-${name}`).setAttribute("aria-pressed", String(name === list));
    }
    get("items").replaceChildren(...this.items[list]);
    this.setLayer("fallen", list === "fallen");
    this.showChosen();
  }

  choose(list: "poses" | "fallen", index: number): void {
    const all = this.scene[list];
    if (!Number.isInteger(index) || !all[index])
      throw new RangeError(`there are ${all.length} ${list}, no index ${index}`);
    this.chosen[list] = index;
    if (list === this.list) this.showChosen();
    else this.setList(list);
  }

  step(by: number): void {
    const most = this.scene[this.list].length - 1;
    if (most < 0) return;
    this.choose(this.list, Math.min(Math.max(this.chosen[this.list] + by, 0), most));
    this.items[this.list][this.chosen[this.list]]!.scrollIntoView({ block: "nearest" });
  }

  /** Shows the chosen pose at rest, or the chosen candidate as it is released. */
  private showChosen(): void {
    this.pause();
    const { pose, fallen, scene } = this;
    this.items[this.list].forEach((item, i) => {
      const button = item.firstElementChild!;
      if (i === this.chosen[this.list]) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
    });
    let details: HTMLElement[];
    if (pose) {
      this.sequence = (this.wanted === "path" ? pathOf(pose, scene) : null) ?? releaseOf(pose, scene);
      details = poseDetails(pose, scene);
      get("said").textContent =
        `Pose ${pose.rank}, ${kindOf(pose.kind).name}` +
        (pose.probability === null ? "" : `, ${percent(pose.probability)}`);
    } else if (fallen) {
      this.sequence = fallOf(fallen, scene);
      details = fallenDetails(fallen, this.chosen.fallen, this.sequence, scene);
      get("said").textContent = `Candidate ${this.chosen.fallen + 1}, ${fateOf(fallen.fate).name}`;
    } else {
      this.sequence = null;
      details = rejectionDetails(scene);
    }
    get("details").replaceChildren(...details);
    get("details").scrollTop = 0;
    this.view?.choose(pose, fallen, this.sequence);
    this.fillTransport();
    this.seek(this.sequence?.name === "release" ? this.sequence.duration : 0);
    this.view?.follow(this.places(), pose?.contacts ?? []);
  }

  private matrix(): Matrix4 {
    return this.sequence?.object.at(this.time) ?? this.view?.beside() ?? new Matrix4();
  }

  /** Where the object is in the course of the sequence. */
  private places(): Matrix4[] {
    const { sequence } = this;
    if (!sequence) return [this.matrix()];
    return PLACES.map((share) => sequence.object.at(share * sequence.duration));
  }

  // Motion.

  private fillTransport(): void {
    const { sequence } = this;
    const still = !sequence || sequence.duration <= 0;
    get("transport").hidden = !sequence;
    get<HTMLButtonElement>("play").disabled = still;
    this.slider.disabled = still;
    get<HTMLButtonElement>("show-path").disabled = !this.pose?.path;
    get("show-release").textContent = sequence?.name === "fall" ? "Fall" : "Release";
    get("show-path").setAttribute("aria-pressed", String(sequence?.name === "path"));
    get("show-release").setAttribute("aria-pressed", String(sequence?.name !== "path"));
    this.slider.title = sequence?.about ?? "";
    let from = 0;
    get("phases").replaceChildren(
      ...(sequence?.phases ?? []).map((phase) => {
        const element = h("span");
        element.style.flexGrow = String(1 + (1000 * (phase.until - from)) / Math.max(sequence!.duration, 1e-6));
        from = phase.until;
        return element;
      }),
    );
  }

  show(sequence: "release" | "path"): void {
    if (sequence === "path" && !this.pose?.path) return;
    this.wanted = sequence;
    if (this.pose) this.showChosen();
  }

  seek(time: number): void {
    const { sequence } = this;
    this.time = Math.min(Math.max(time, 0), sequence?.duration ?? 0);
    if (!sequence) {
      this.view?.place(this.matrix(), null, false);
      return;
    }
    this.view?.place(this.matrix(), sequence.gripper?.(this.time) ?? null, sequence.rests(this.time));
    const share = sequence.duration > 0 ? this.time / sequence.duration : 1;
    this.slider.value = String(1000 * share);
    this.slider.style.setProperty("--share", String(share));
    const clock = `${this.time.toFixed(2)} / ${sequence.duration.toFixed(2)} s`;
    get("clock").textContent = clock;
    this.slider.setAttribute("aria-valuetext", `${clock}, ${this.phase() ?? ""}`);
    const phase = sequence.phases.findIndex((one) => one.name === this.phase());
    get("phase").textContent = this.phase();
    [...get("phases").children].forEach((element, i) => element.classList.toggle("now", i === phase));
  }

  private phase(): string | null {
    const phases = this.sequence?.phases ?? [];
    return (phases.find((one) => this.time < one.until - 1e-6) ?? phases[phases.length - 1])?.name ?? null;
  }

  /** Plays from here, or from the start if it is at the end; resolves when it stops. */
  play(): Promise<void> {
    const { sequence } = this;
    if (!sequence || sequence.duration <= 0) return Promise.resolve();
    if (this.time >= sequence.duration - 1e-6) this.seek(0);
    if (!this.playing) {
      this.playing = true;
      this.markPlaying();
      this.last = performance.now();
      requestAnimationFrame((now) => this.tick(now));
    }
    return new Promise((resolve) => this.stopped.push(resolve));
  }

  private tick(now: number): void {
    if (!this.playing || !this.sequence) return;
    const speed = Number(get<HTMLSelectElement>("speed").value);
    this.seek(this.time + (Math.max(now - this.last, 0) / 1000) * speed);
    this.last = Math.max(now, this.last);
    if (this.time >= this.sequence.duration) this.pause();
    else requestAnimationFrame((next) => this.tick(next));
  }

  pause(): void {
    this.playing = false;
    this.markPlaying();
    for (const resolve of this.stopped.splice(0)) resolve();
  }

  private markPlaying(): void {
    get("play").setAttribute("aria-label", this.playing ? "Pause" : "Play");
    get("play").classList.toggle("playing", this.playing);
  }

  private togglePlay(): void {
    if (this.playing) this.pause();
    else void this.play();
  }

  // Picture.

  setLayer(id: string, on: boolean): void {
    this.view?.show(id, on);
    const box = document.querySelector<HTMLInputElement>(`[data-layer="${id}"]`);
    if (box) box.checked = on;
    if (on && id === "forces") this.seek(this.time);
  }

  fit(): void {
    this.view?.fit(this.places(), this.pose?.contacts ?? []);
    if (!this.sequence) this.view?.fitAll();
  }

  fitAll(): void {
    this.view?.fitAll();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    for (const [name, colour] of Object.entries(PALETTES[theme])) {
      document.documentElement.style.setProperty(`--picture-${name}`, colour);
    }
    this.view?.setTheme(theme);
    this.view?.choose(this.pose, this.fallen, this.sequence);
  }

  private seeThrough(): void {
    const on = get("see-through").getAttribute("aria-pressed") !== "true";
    get("see-through").setAttribute("aria-pressed", String(on));
    this.view?.seeThrough(on);
  }

  picture(): Promise<Blob> {
    return this.view ? this.view.picture() : Promise.reject(new Error("there is no picture without WebGL"));
  }

  private async save(): Promise<void> {
    const url = URL.createObjectURL(await this.picture());
    const name = this.scene.object.name.replace(/\.[^.]*$/, "").replace(/[^\w-]+/g, "_");
    h("a", {
      href: url,
      download: `hangpose_${name}_${this.list === "poses" ? "pose" : "fallen"}_${this.chosen[this.list] + 1}.png`,
    }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }

  private help(): void {
    const box = get<HTMLDialogElement>("help-box");
    if (box.open) box.close();
    else box.showModal();
  }

  // Keys and buttons.

  private bind(): void {
    const on = (id: string, act: () => void) => get(id).addEventListener("click", act);
    on("fit", () => this.fit());
    on("see-through", () => this.seeThrough());
    on("save", () => void this.save());
    on("theme", () => this.setTheme(this.theme === "dark" ? "light" : "dark"));
    on("help", () => this.help());
    on("tab-poses", () => this.setList("poses"));
    on("tab-fallen", () => this.setList("fallen"));
    on("show-release", () => this.show("release"));
    on("show-path", () => this.show("path"));
    on("play", () => this.togglePlay());
    this.slider.addEventListener("input", () => {
      this.pause();
      this.seek((Number(this.slider.value) / 1000) * (this.sequence?.duration ?? 0));
    });
    this.system.addEventListener("change", () => this.setTheme(this.system.matches ? "dark" : "light"));
    for (const id of ["see-through", "save", "fit"]) get<HTMLButtonElement>(id).disabled = !this.view;
    document.addEventListener("keydown", (event) => this.key(event));
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (get<HTMLDialogElement>("help-box").open) {
      if (event.key === "?") this.help();
      return;
    }
    const target = event.target instanceof HTMLElement ? event.target : document.body;
    if (target.matches("select")) return;
    if (event.key === " " && target.matches("button, summary, input[type=checkbox]")) return;
    if (target.matches("input[type=range]") && /^(Arrow|Home|End|Page)/.test(event.key)) return;
    const duration = this.sequence?.duration ?? 0;
    const move = (time: number) => {
      this.pause();
      this.seek(time);
    };
    const actions: Record<string, () => void> = {
      ArrowDown: () => this.step(1),
      j: () => this.step(1),
      ArrowUp: () => this.step(-1),
      k: () => this.step(-1),
      ArrowLeft: () => move(this.time - STEP * duration),
      ArrowRight: () => move(this.time + STEP * duration),
      Home: () => move(0),
      End: () => move(duration),
      " ": () => this.togglePlay(),
      r: () => this.show("release"),
      p: () => this.show("path"),
      c: () => this.setList(this.list === "poses" ? "fallen" : "poses"),
      f: () => this.fit(),
      a: () => this.fitAll(),
      x: () => this.seeThrough(),
      l: () => (get<HTMLDetailsElement>("layers").open = !get<HTMLDetailsElement>("layers").open),
      t: () => this.setTheme(this.theme === "dark" ? "light" : "dark"),
      s: () => void (this.view && this.save()),
      "?": () => this.help(),
    };
    const action = Object.hasOwn(actions, event.key) ? actions[event.key] : undefined;
    if (!action) return;
    event.preventDefault();
    action();
  }

  state(): State {
    const { sequence, view } = this;
    const gripper = sequence?.gripper?.(this.time) ?? null;
    return {
      list: this.list,
      pose: this.pose ? this.chosen.poses : null,
      fallen: this.fallen ? this.chosen.fallen : null,
      sequence: sequence?.name ?? null,
      seconds: this.time,
      duration: sequence?.duration ?? 0,
      playing: this.playing,
      matrix: sequence ? rows(view ? view.objectMatrix() : this.matrix()) : null,
      gripper: gripper && { matrix: rows(gripper.matrix), opening: gripper.opening },
      phase: this.phase(),
      theme: this.theme,
      layers: Object.fromEntries((view?.layers ?? []).map((layer) => [layer.id, layer.on])),
      webgl: view !== null,
      help: get<HTMLDialogElement>("help-box").open,
    };
  }
}

/** For tests and notebooks: see viewer/README.md. */
function api(page: Page) {
  return {
    state: () => page.state(),
    select: (index: number) => page.choose("poses", index),
    selectFallen: (index: number) => page.choose("fallen", index),
    show: (sequence: "release" | "path") => page.show(sequence),
    play: () => page.play(),
    pause: () => page.pause(),
    seek: (seconds: number) => {
      page.pause();
      page.seek(seconds);
    },
    setLayer: (id: string, on: boolean) => page.setLayer(id, on),
    setTheme: (theme: Theme) => page.setTheme(theme),
    fit: () => page.fit(),
    fitAll: () => page.fitAll(),
    picture: () => page.picture(),
  };
}

declare global {
  interface Window {
    hangpose: { ready: Promise<void> } & Partial<ReturnType<typeof api>>;
  }
}

/** Resolves after the next frame, or soon where the page is hidden and has none. */
function nextFrame(): Promise<void> {
  return new Promise((resolve) => {
    requestAnimationFrame(() => resolve());
    setTimeout(resolve, 500);
  });
}

function start(): Promise<void> {
  try {
    const page = new Page(readScene(get("scene").textContent ?? ""));
    Object.assign(window.hangpose, api(page));
    return nextFrame();
  } catch (error) {
    get("app").replaceChildren(
      h(
        "div",
        { class: "broken", role: "alert" },
        h("h1", {}, "This page cannot be shown"),
        h("p", {}, (error as Error).message),
        h(
          "p",
          {},
          "The page and its scene may be from different versions of hangpose, or the file may be damaged: " +
            "write it again.",
        ),
      ),
    );
    return Promise.reject(error as Error);
  }
}

window.hangpose = { ready: Promise.resolve() };
window.hangpose.ready = start();
