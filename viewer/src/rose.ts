// The tilts that a pose survives, as a polar plot seen from above.

import { Vector3 } from "three";
import { h, svg } from "./dom";
import { degrees } from "./format";
import { directionNames } from "./words";

/** Radius of the outer ring in units of the drawing. */
const RADIUS = 84;
/** Angle between two rings, degrees. */
const RING = 20;
/** Free angle between the outer ring and the last one inside, degrees. */
const GAP = 12;

function at(direction: number, radius: number): [number, number] {
  const angle = (direction * Math.PI) / 4;
  return [radius * Math.cos(angle), -radius * Math.sin(angle)];
}

export function rose(tilts: readonly number[], most: number, up: Vector3): HTMLElement {
  const names = directionNames(up);
  const picture = svg("svg", {
    viewBox: "-112 -106 224 212",
    class: "rose",
    role: "img",
    "aria-label": `Tilts survived: ${tilts.map((tilt, i) => `${names[i]} ${degrees(tilt)}`).join(", ")}`,
  });
  const scale = (tilt: number) => (RADIUS * Math.min(Math.max(tilt, 0), most)) / most;
  const rings: number[] = [];
  for (let ring = RING; ring < (most * 180) / Math.PI - GAP; ring += RING) rings.push((ring * Math.PI) / 180);
  for (const ring of rings) picture.append(svg("circle", { r: scale(ring), class: "ring" }));
  picture.append(svg("circle", { r: RADIUS, class: "ring outer" }));
  for (let i = 0; i < 8; i++) {
    const [x, y] = at(i, RADIUS);
    picture.append(svg("line", { x1: 0, y1: 0, x2: x, y2: y, class: "spoke" }));
  }
  picture.append(
    svg("polygon", {
      class: "survived",
      points: tilts
        .map((tilt, i) =>
          at(i, scale(tilt))
            .map((v) => v.toFixed(2))
            .join(","),
        )
        .join(" "),
    }),
  );
  const least = Math.min(...tilts);
  tilts.forEach((tilt, i) => {
    const [cx, cy] = at(i, scale(tilt));
    const weakest = tilt === least && least < most - 1e-3;
    picture.append(
      svg(
        "circle",
        { cx, cy, r: weakest ? 4.5 : 3, class: weakest ? "tip weakest" : "tip" },
        svg("title", {}, `${names[i]}: ${degrees(tilt)}`),
      ),
    );
  });
  for (const ring of [...rings, most]) {
    const [x, y] = at(-0.5, scale(ring));
    picture.append(svg("text", { x: x, y: y + 3, class: "scale" }, `${Math.round((ring * 180) / Math.PI)}°`));
  }
  for (const i of [0, 2, 4, 6]) {
    const [x, y] = at(i, RADIUS + 13);
    picture.append(svg("text", { x, y: y + 4, class: "axis" }, names[i]!));
  }
  return h("figure", { class: "rose-figure" }, picture);
}
