// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Leading the tool with keys and gamepads: directions as the camera sees them, levelled, so that
// "away" is away on the floor. The gamepad rumbles with the drag.
import { Vector3, type Camera } from "three";
import { mobility } from "./heavy_pointer";
import { rumble, withDeadZone } from "./lead";
import type { Leader } from "./leader";

const metresPerSecond = 0.25;
const radiansPerSecond = 0.8;
const slowly = 0.2;
const rumblePeriod = 0.1; // [s] between effects, each a little longer than that

/** Keys that lead while they are down: right, away, up; then about x, y, z of the tool. */
const keyAxes: Record<string, readonly [axis: number, sign: number]> = {
  KeyD: [0, 1],
  KeyA: [0, -1],
  KeyW: [1, 1],
  KeyS: [1, -1],
  KeyE: [2, 1],
  KeyQ: [2, -1],
  KeyI: [3, 1],
  KeyK: [3, -1],
  KeyJ: [4, 1],
  KeyL: [4, -1],
  KeyU: [5, 1],
  KeyO: [5, -1],
};

export class Jog {
  halfAt = 2;
  private readonly down = new Set<string>();
  private slow = false;
  private lastRumble = 0;
  private wasMoving = false;

  constructor(
    private readonly leader: Leader,
    private readonly camera: Camera,
    private readonly felt: () => number,
    private readonly onGamepad: (text: string) => void,
  ) {}

  /** @return whether the key leads */
  key(code: string, isDown: boolean, slow: boolean): boolean {
    this.slow = slow;
    if (!(code in keyAxes)) return false;
    if (isDown) this.down.add(code);
    else this.down.delete(code);
    return true;
  }

  releaseAll(): void {
    this.down.clear();
  }

  /** Once a frame. @param seconds since the last one */
  step(seconds: number): void {
    const wish = this.wishOfKeys();
    this.addGamepad(wish);
    const moving = wish.some((x) => x !== 0);
    if (moving) this.lead(wish, Math.min(seconds, 0.1));
    else if (this.wasMoving) this.leader.end();
    this.wasMoving = moving;
  }

  private wishOfKeys(): number[] {
    const wish = [0, 0, 0, 0, 0, 0];
    for (const code of this.down) {
      const [axis, sign] = keyAxes[code]!;
      wish[axis]! += sign * (this.slow ? slowly : 1);
    }
    return wish;
  }

  private addGamepad(wish: number[]): void {
    const pad = navigator.getGamepads().find((found) => found?.connected) ?? null;
    if (!pad) return;
    const axis = (n: number): number => withDeadZone(pad.axes[n] ?? 0);
    const pressed = (n: number): number => pad.buttons[n]?.value ?? 0;
    wish[0]! += axis(0);
    wish[1]! -= axis(1);
    wish[2]! += pressed(7) - pressed(6);
    wish[4]! -= axis(2);
    wish[3]! -= axis(3);
    wish[5]! += pressed(5) - pressed(4);
    this.rumble(pad);
  }

  private rumble(pad: Gamepad): void {
    const strength = rumble(this.felt(), this.halfAt);
    const now = performance.now() / 1000;
    // Older typings and browsers know no actuator.
    const actuator = pad.vibrationActuator as GamepadHapticActuator | null | undefined;
    this.onGamepad(`${pad.id}: ${actuator ? `rumble ${Math.round(100 * strength)} %` : "does not rumble"}`);
    if (!actuator || now - this.lastRumble < rumblePeriod || strength === 0) return;
    this.lastRumble = now;
    actuator
      .playEffect("dual-rumble", {
        duration: 1500 * rumblePeriod,
        strongMagnitude: strength,
        weakMagnitude: strength,
      })
      .catch(() => undefined); // a pad that was just unplugged
  }

  private lead(wish: readonly number[], seconds: number): void {
    this.leader.begin();
    const away = this.camera.getWorldDirection(new Vector3()).setZ(0);
    if (away.lengthSq() < 1e-6) away.set(0, 1, 0);
    away.normalize();
    const right = new Vector3(away.y, -away.x, 0);
    const way = mobility(this.felt(), this.halfAt) * metresPerSecond * seconds;
    const step = new Vector3()
      .addScaledVector(right, wish[0]! * way)
      .addScaledVector(away, wish[1]! * way)
      .add(new Vector3(0, 0, wish[2]! * way));
    this.leader.moveTo(this.leader.place.add(step));
    this.leader.rotate(
      new Vector3(wish[3], wish[4], wish[5]).multiplyScalar(radiansPerSecond * seconds),
    );
  }
}
