// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A pointer that drag makes heavy: near a part the same movement of the mouse carries it less far.
// It stands for the hand on a master arm, which no mouse can push back at.

/**
 * What share of the mouse's movement the pointer makes.
 * @param felt drag against the hand, >= 0 [N]
 * @param halfAt drag at which the pointer goes half as far [N]
 * @return 1 where nothing is felt, falling, never 0: drag slows, it does not stop
 */
export function mobility(felt: number, halfAt: number): number {
  if (!(felt > 0) || !(halfAt > 0)) return 1;
  return 1 / (1 + felt / halfAt);
}

export class HeavyPointer {
  constructor(
    public x: number,
    public y: number,
  ) {}

  /** @param dx movement of the mouse [px]; @param share as `mobility` says */
  move(dx: number, dy: number, share: number): void {
    this.x += dx * share;
    this.y += dy * share;
  }
}
