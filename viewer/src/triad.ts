// The axes of the supporter in the corner of the picture, and the direction of gravity.

import { Vector3 } from "three";
import type { Camera } from "three";
import { svg } from "./dom";
import type { Vec3 } from "./scene";

const LENGTH = 24;

export function drawTriad(element: HTMLElement | SVGElement, camera: Camera, up: Vec3): void {
  const turn = camera.quaternion.clone().invert();
  const axes: [string, Vector3][] = [
    ["x", new Vector3(1, 0, 0)],
    ["y", new Vector3(0, 1, 0)],
    ["z", new Vector3(0, 0, 1)],
    ["g", new Vector3(...up).normalize().negate()],
  ];
  const seen = axes
    .map(([name, axis]) => [name, axis.applyQuaternion(turn)] as const)
    .sort(([, a], [, b]) => a.z - b.z);
  element.replaceChildren(
    ...seen.flatMap(([name, { x, y }]) => {
      const [tipX, tipY] = [LENGTH * x, -LENGTH * y];
      const far = Math.max(Math.hypot(x, y), 1e-3);
      const [textX, textY] = [tipX + (8 * x) / far, tipY - (8 * y) / far];
      return [
        svg("line", { x1: 0, y1: 0, x2: tipX, y2: tipY, class: `axis-${name}` }),
        svg("text", { x: textX, y: textY + 3.5, class: `axis-${name}` }, name),
      ];
    }),
  );
}
