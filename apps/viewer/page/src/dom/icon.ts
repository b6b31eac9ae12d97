// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Small pictures for buttons, drawn here: strokes on a grid of 16.

const strokes = {
  orbit: "M8 5.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5M14 8c0 1.6-2.7 2.9-6 2.9S2 9.600 2 8s2.700-2.900 6-2.900S14 6.400 14 8",
  pick: "M8 1.500v3M8 11.500v3M1.500 8h3M11.500 8h3M8 4.500a3.500 3.500 0 1 0 0 7 3.500 3.500 0 0 0 0-7",
  measure: "M2 11 11 2l3 3-9 9zM5 8l1.500 1.500M7 6l1 1M9 4l1.500 1.500",
  drive: "M2.500 14h6M5.500 14V9.500L8.500 5l4 1.500M5.500 9.500l-2-1M12.500 6.500l1.500-2M12.500 6.500l1.800 1.500",
  eye: "M1.500 8S4 3.800 8 3.800 14.500 8 14.500 8 12 12.200 8 12.200 1.500 8 1.500 8M8 6.200a1.800 1.800 0 1 0 0 3.600 1.800 1.800 0 0 0 0-3.600",
  eye_off: "M3 13 13 3M6.500 4a6 6 0 0 1 1.500-.2c4 0 6.500 4.200 6.500 4.200a11 11 0 0 1-2 2.300M4 5.400A11 11 0 0 0 1.500 8S4 12.200 8 12.200c.7 0 1.400-.1 2-.4",
  theme: "M8 2.500a5.500 5.500 0 1 0 0 11zM8 2.500a5.500 5.500 0 0 1 0 11",
  help: "M8 1.800a6.200 6.200 0 1 0 0 12.400A6.200 6.200 0 0 0 8 1.800M6.200 6.300C6.200 5.200 7 4.600 8 4.600s1.800.7 1.800 1.700c0 1.300-1.800 1.400-1.800 2.700M8 11.300v.1",
  left: "M2 3h12v10H2zM6 3v10",
  right: "M2 3h12v10H2zM10 3v10",
  strip: "M2 3h12v10H2zM2 9.500h12",
  play: "M5 3.200v9.600L12.500 8z",
  pause: "M5.500 3.500v9M10.500 3.500v9",
  loop: "M3 8a4 4 0 0 1 4-4h5M10 2l2 2-2 2M13 8a4 4 0 0 1-4 4H4M6 14l-2-2 2-2",
  start: "M4 3.500v9M12 3.500 6.500 8l5.500 4.500z",
  home: "M2.500 7.500 8 3l5.500 4.500M4 6.500v6.500h8V6.500",
  close: "M4 4l8 8M12 4l-8 8",
  add: "M8 3v10M3 8h10",
  stop: "M4 4h8v8H4z",
  down: "M4 6l4 4 4-4",
} as const;

export type IconName = keyof typeof strokes;

export function icon(name: IconName): SVGSVGElement {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("class", "icon");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(space, "path");
  path.setAttribute("d", strokes[name]);
  svg.append(path);
  return svg;
}
