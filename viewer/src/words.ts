// What the page says of kinds, fates and directions.

import { Vector3 } from "three";
import { axesOf, nameOf } from "./axes";

const KINDS: Record<string, { name: string; means: string }> = {
  threaded: {
    name: "Threaded",
    means: "A bar of the supporter runs through a loop of the object. Only the way past the end of the bar frees it.",
  },
  hooked: { name: "Hooked", means: "An open hook of the one holds the other. Lifting frees it." },
  capped: { name: "Capped", means: "The object stands over a tip of the supporter with its cavity. Lifting frees it." },
  balanced: { name: "Balanced", means: "Friction or balance holds it. A push frees it." },
};

const NOT_SIMULATED = {
  name: "Not simulated",
  means: "A pose of the published method, which does not release the object in a simulation.",
};

export function kindOf(kind: string | null): { name: string; means: string } {
  if (kind === null) return NOT_SIMULATED;
  return KINDS[kind] ?? { name: kind, means: "" };
}

const FATES: Record<string, { name: string; means: string }> = {
  rotates_off: { name: "Rotates off", means: "Released here, the object turns and falls off the supporter." },
  slides_off: {
    name: "Slides off",
    means: "Released here, the object slides off the supporter or falls through it without turning much.",
  },
  moves: { name: "Keeps moving", means: "Released here, the object still moves when the time is up." },
};

export function fateOf(fate: string): { name: string; means: string } {
  return FATES[fate] ?? { name: fate, means: "" };
}

/** Names of the eight directions of the tilts, such as "+x" and "between +x and +y". */
export function directionNames(up: Vector3): string[] {
  const { ahead, aside } = axesOf(up);
  const axes = [ahead, aside, ahead.clone().negate(), aside.clone().negate()];
  const names = axes.map((axis, i) => nameOf(axis) ?? `${90 * i}°`);
  return names.flatMap((name, i) => [name, `between ${name} and ${names[(i + 1) % 4]!}`]);
}
