// What the page says of the chosen pose, beside the picture.

import { Vector3 } from "three";
import { h } from "./dom";
import { count, degrees, millimetres, percent, plural, point, ratio, seconds, speed, vector } from "./format";
import { lengthOf, pathOf } from "./motion";
import type { Sequence } from "./motion";
import { rose } from "./rose";
import type { Fallen, HangingPose, Pose, Scene, Unseen } from "./scene";
import { directionNames, fateOf, kindOf } from "./words";

/** A figure with its name; what it means opens below it. */
function fact(name: string, value: string, means: string, share: number | null = null): HTMLElement {
  const bar = share === null ? null : meter(share);
  return h(
    "details",
    { class: "fact" },
    h("summary", { title: means }, h("span", { class: "name" }, name), bar, h("span", { class: "value" }, value)),
    h("p", {}, means),
  );
}

function meter(share: number): HTMLElement {
  const inside = h("span");
  inside.style.width = `${100 * Math.min(Math.max(share, 0), 1)}%`;
  return h("span", { class: "meter", "aria-hidden": "true" }, inside);
}

function section(title: string, ...children: (Node | string | null)[]): HTMLElement {
  return h("section", {}, h("h3", {}, title), ...children);
}

function numbersOf(name: string, pose: Pose): HTMLElement[] {
  return [
    h("dt", {}, name),
    h(
      "dd",
      {},
      h("span", {}, `${point(pose.position)} mm`),
      h("br"),
      h("span", { class: "quaternion" }, `q ${vector(pose.quaternion_xyzw, 4)}`),
    ),
  ];
}

function firmness(pose: HangingPose, scene: Scene): HTMLElement | null {
  const margin = pose.margin;
  if (!margin) return null;
  const up = new Vector3(...scene.supporter.up).normalize();
  const least = Math.min(...margin.tilts);
  const names = directionNames(up);
  const most = degrees(scene.mostTilt);
  const held = least > scene.mostTilt - 1e-3;
  const untried = margin.tilts.filter((tilt) => tilt === 0).length;
  const summary = held
    ? `Stays at every tilt of gravity up to ${most}, the largest that is tested.`
    : `Leaves first when gravity tilts in the direction ${names[margin.tilts.indexOf(least)]}, at ${degrees(least)}.`;
  return section(
    "How firmly it hangs",
    rose(margin.tilts, scene.mostTilt, up),
    h(
      "p",
      { class: "caption" },
      summary,
      ` Seen from above.${untried > 0 ? ` ${plural(untried, "direction")} at 0° may not have been tried.` : ""}`,
    ),
    fact(
      "Least tilt",
      held ? `${most} or more` : degrees(least),
      "Gravity turns slowly towards each of eight directions, with 70 % of the friction. This is the " +
        "tilt at which the object last touched the supporter. It is larger than the static limit, because " +
        "leaving takes time.",
    ),
    fact(
      "Knock",
      `${held ? "at least " : ""}${speed(margin.knock_speed)}`,
      "Speed of a knock that would carry the centre of mass over the lowest way out that was found.",
    ),
    fact(
      "Jolt",
      margin.jolt_time >= 1 ? `stays ${seconds(margin.jolt_time)}` : `leaves after ${seconds(margin.jolt_time)}`,
      "How long the object stays, at most 1 s, when gravity tilts at once by 21.8° in the weakest " +
        "direction and only friction ends the swing. A robot that carries the supporter starts or stops " +
        "like that at 0.4 g.",
    ),
    fact(
      "Centre of mass",
      `may be off by ${millimetres(margin.centre_of_mass_radius)}`,
      "An error of the assumed centre of mass of this size turns the object by the least tilt.",
    ),
    fact(
      "Sinking when tilted",
      millimetres(margin.tilted_sinking),
      "Largest drop of the centre of mass while gravity tilts by up to 52°. An object that drops then lies on a ledge.",
    ),
    fact(
      "Rise to escape",
      `${millimetres(margin.escape_rise)} (ratio ${ratio(margin.escape_ratio)})`,
      "Least rise of the centre of mass over the ways out that were found. Where none was found, the " +
        "highest rise that was seen. The ratio is over the distance from the contacts to the centre of " +
        "mass.",
    ),
  );
}

function view(direction: readonly number[], frame: string): string {
  return Math.hypot(...direction) > 0
    ? ` A camera in the direction (${vector(direction, 2)}) of the ${frame}'s frame would see most of it.`
    : "";
}

function unseen(all: Unseen | null, scene: Scene): HTMLElement | null {
  if (!all) return null;
  const given = scene.object.viewpoints.length + scene.supporter.viewpoints.length > 0;
  if (!given && all.object + all.shadow + all.supporter === 0) {
    return section(
      "Not seen by any camera",
      h("p", { class: "caption" }, "No viewpoints were given, so all of it counts as seen."),
    );
  }
  return section(
    "Not seen by any camera",
    fact(
      "Object",
      percent(all.object),
      `Share of the directions around the object from which no camera looked at it.${view(all.object_view, "object")}`,
      all.object,
    ),
    fact(
      "Shadow",
      percent(all.shadow),
      "Share of the supporter near the object that is in the shadow of the object's mesh: the object " +
        "may be there, too.",
      all.shadow,
    ),
    fact(
      "Supporter",
      percent(all.supporter),
      `Share of the supporter close to the object that was guessed.${view(all.supporter_view, "supporter")}`,
      all.supporter,
    ),
  );
}

function contacts(pose: HangingPose): HTMLElement | null {
  if (pose.contacts.length === 0) return null;
  const rows = pose.contacts.map(({ position, force }, i) =>
    h("tr", {}, h("td", {}, String(i + 1)), h("td", {}, point(position)), h("td", {}, percent(force))),
  );
  return section(
    "Contacts at rest",
    h(
      "table",
      {},
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", { scope: "col" }, "#"),
          h("th", { scope: "col" }, "Position, mm"),
          h("th", { scope: "col" }, "Force / weight"),
        ),
      ),
      h("tbody", {}, ...rows),
    ),
  );
}

function path(pose: HangingPose, scene: Scene): HTMLElement | null {
  if (pose.pathFailure) {
    return section("Path", h("p", { class: "notice" }, h("strong", {}, "No path: "), pose.pathFailure));
  }
  const sequence = pathOf(pose, scene);
  if (!pose.path || !sequence) return null;
  return section(
    "Path",
    fact(
      "Duration",
      seconds(sequence.object.end - sequence.object.start),
      "Time of the object from the first to the last waypoint, at the speeds that were asked for.",
    ),
    fact("Length", millimetres(lengthOf(sequence.object.line)), "Length of the way of the centre of mass."),
    fact(
      "Clearance",
      millimetres(pose.path.clearance),
      "Least distance of the object, or of the gripper that holds it, from everything else between the " +
        "start and the release pose.",
    ),
    fact(
      "Waypoints",
      pose.path.gripper.length > 0
        ? `${pose.path.waypoints.length} + ${pose.path.gripper.length} of the gripper`
        : String(pose.path.waypoints.length),
      "Between two waypoints the centre of mass moves in a straight line while the object turns about a fixed axis.",
    ),
  );
}

export function poseDetails(pose: HangingPose, scene: Scene): HTMLElement[] {
  const kind = kindOf(pose.kind);
  const chances =
    pose.probability === null
      ? null
      : section(
          "How likely it hangs",
          fact(
            "Hangs and stays",
            percent(pose.probability),
            "Probability that the object hangs and stays when it is let go at the release pose.",
            pose.probability,
          ),
          pose.robustness === null
            ? null
            : fact(
                "Also when tilted",
                percent(pose.robustness),
                "Probability that it also stays when gravity tilts by 21.8° towards any side: what a robot that " +
                  "moves the supporter needs.",
                pose.robustness,
              ),
        );
  const release =
    pose.tolerance === null && pose.clearance === null && pose.sinking === null
      ? null
      : section(
          "How to release it",
          pose.tolerance
            ? fact(
                "Tolerance",
                `${millimetres(pose.tolerance.position)} or ${degrees(pose.tolerance.rotation)}`,
                "How far the object may be from the release pose when it is let go, by displacement or by " +
                  "rotation about its centre of mass. The two add up: half of either is fine together.",
              )
            : null,
          pose.clearance === null
            ? null
            : fact("Clearance", millimetres(pose.clearance), "Distance from the supporter at the release pose."),
          pose.sinking === null
            ? null
            : fact(
                "Sinking",
                millimetres(pose.sinking),
                "How far the centre of mass sinks from the release pose to the rest pose.",
              ),
        );
  return [
    h(
      "header",
      {},
      h("p", { class: "overline" }, `Pose ${pose.rank} of ${scene.poses.length}`),
      h("h2", {}, kind.name),
      h("p", { class: "lead" }, kind.means),
    ),
    chances,
    firmness(pose, scene),
    release,
    path(pose, scene),
    contacts(pose),
    unseen(pose.unseen, scene),
    section(
      "Poses in supporter coordinates",
      h(
        "dl",
        { class: "numbers" },
        ...numbersOf("Release", pose.release),
        ...(pose.rest ? numbersOf("Rest", pose.rest) : []),
      ),
    ),
  ].filter((part): part is HTMLElement => part !== null);
}

/** How far the centre of mass falls, metres. */
export function fallHeight(sequence: Sequence, scene: Scene): number {
  const up = new Vector3(...scene.supporter.up).normalize();
  const line = sequence.object.line;
  return line.length > 0 ? line[0]!.dot(up) - line[line.length - 1]!.dot(up) : 0;
}

export function fallenDetails(fallen: Fallen, index: number, sequence: Sequence, scene: Scene): HTMLElement[] {
  const { counts } = scene;
  const fell = counts ? counts.rotated_off + counts.slid_off + counts.moving : 0;
  const more =
    fell > scene.fallen.length
      ? h(
          "p",
          { class: "caption" },
          `${count(fell)} fell in all. The page holds ${count(scene.fallen.length)} of them, spread evenly ` +
            "over the search.",
        )
      : null;
  return [
    h(
      "header",
      {},
      h("p", { class: "overline" }, `Candidate ${index + 1} of ${scene.fallen.length} that fell`),
      h("h2", {}, fateOf(fallen.fate).name),
      h("p", { class: "lead" }, fateOf(fallen.fate).means),
      more,
    ),
    section(
      "How it fell",
      fact("After", seconds(sequence.duration), "Time from the release to the end of the simulated motion."),
      fact("Fell", millimetres(fallHeight(sequence, scene)), "How far the centre of mass sank in that time."),
    ),
    section("Pose in supporter coordinates", h("dl", { class: "numbers" }, ...numbersOf("Release", fallen.release))),
  ];
}

export function rejectionDetails(scene: Scene): HTMLElement[] {
  const { rejection } = scene;
  const sentence = rejection?.reason ?? "No pose was given.";
  return [
    h(
      "header",
      {},
      h("p", { class: "overline" }, "No pose"),
      h("h2", {}, "Nothing hangs"),
      h("p", { class: "notice" }, sentence[0]!.toUpperCase() + sentence.slice(1).replace(/\.?$/, ".")),
      rejection ? h("p", { class: "caption" }, "Stage: ", h("code", {}, rejection.stage)) : null,
      h(
        "p",
        { class: "caption" },
        "The picture shows the object beside the supporter.",
        scene.fallen.length > 0 ? " The list of what fell shows where it was released." : "",
      ),
    ),
  ];
}
