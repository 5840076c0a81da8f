// Numbers with their units, as the page writes them.

const SPACE = "\u00a0";
const UNKNOWN = "–";

function known(value: number | null | undefined): value is number {
  return typeof value === "number" && Number.isFinite(value);
}

export function millimetres(metres: number | null | undefined): string {
  if (!known(metres)) return UNKNOWN;
  const mm = 1000 * metres;
  if (mm > 0 && mm < 0.05) return `<${SPACE}0.1${SPACE}mm`;
  if (Math.abs(mm) >= 1000) return `${metres.toFixed(2)}${SPACE}m`;
  return `${mm
    .toFixed(Math.abs(mm) < 99.95 ? 1 : 0)
    .replace(/^-0\.0$/, "0.0")
    .replace("-", "−")}${SPACE}mm`;
}

export function degrees(radians: number | null | undefined): string {
  if (!known(radians)) return UNKNOWN;
  const value = (180 * radians) / Math.PI;
  return `${value.toFixed(Math.abs(value) < 9.95 ? 1 : 0)}°`;
}

export function percent(share: number | null | undefined): string {
  if (!known(share)) return UNKNOWN;
  const value = 100 * share;
  // What is possible is not 0 %, and what is not certain is not 100 %.
  const isClose = (value > 0 && value < 1) || (value > 99 && value < 100);
  return `${value.toFixed(isClose ? 1 : 0)}${SPACE}%`;
}

export function seconds(time: number | null | undefined): string {
  if (!known(time)) return UNKNOWN;
  return time < 0.9995 && time > 0
    ? `${(1000 * time).toFixed(0)}${SPACE}ms`
    : `${time.toFixed(time < 9.95 ? 1 : 0)}${SPACE}s`;
}

export function speed(metresPerSecond: number | null | undefined): string {
  return known(metresPerSecond) ? `${metresPerSecond.toFixed(2)}${SPACE}m/s` : UNKNOWN;
}

export function ratio(value: number | null | undefined): string {
  return known(value) ? value.toFixed(2) : UNKNOWN;
}

export function count(value: number): string {
  return String(value).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** Coordinates in millimetres. */
export function point(metres: readonly number[]): string {
  return metres
    .map((x) =>
      (1000 * x)
        .toFixed(1)
        .replace(/^-0\.0$/, "0.0")
        .replace("-", "−"),
    )
    .join(", ");
}

/** The numbers of a vector or quaternion without a unit. */
export function vector(values: readonly number[], digits: number): string {
  return values.map((x) => x.toFixed(digits).replace("-", "−")).join(", ");
}

/** "1 pose", "2 poses". */
export function plural(n: number, one: string, many = `${one}s`): string {
  return `${count(n)} ${n === 1 ? one : many}`;
}
