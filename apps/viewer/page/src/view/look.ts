// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Colours of the room by theme. Red to yellow belongs to the ranks, so that everything else keeps
// to grey and blue.
export interface Look {
  object: string;
  edge: string;
  arm: string;
  drag: string;
  ghost: string;
  accent: string;
  grid: string;
  restingPoint: string;
  outline: string;
}

export type Theme = "dark" | "light";

export const looks: Record<Theme, Look> = {
  dark: {
    object: "#8b95a1",
    edge: "#2c343e",
    arm: "#6ea3d8",
    drag: "#ffffff",
    ghost: "#9fb0c2",
    accent: "#62adff",
    grid: "#33404e",
    restingPoint: "#c4d3e2",
    outline: "#9fb0c2",
  },
  light: {
    object: "#c3cad2",
    edge: "#5d6875",
    arm: "#4b82ba",
    drag: "#101418",
    ghost: "#7b8a9a",
    accent: "#0a5fbf",
    grid: "#c2cad4",
    restingPoint: "#23394f",
    outline: "#56636f",
  },
};
