// Where two wheels bring the robot.
import { type Dance, MOTOR } from './dance';

/** Diameter of a wheel, and how far both are apart, of the drawn robot. */
export const WHEEL_MM = 80;
export const TRACK_MM = 160;

/** On the floor, in mm and rad; forwards is along the heading. */
export interface Stand {
  x: number;
  y: number;
  heading: number;
}

/** Where the robot is at the end of every frame, and before the first. */
export function roll(dance: Dance): Stand[] {
  const stands: Stand[] = [{ x: 0, y: 0, heading: 0 }];
  const rolled = (motor: number, frame: number) =>
    ((dance.angle(motor, frame) - dance.angle(motor, frame - 1)) / 360) * Math.PI * WHEEL_MM;
  let { x, y, heading } = { x: 0, y: 0, heading: 0 };
  for (let frame = 1; frame <= dance.frames; frame += 1) {
    const [left, right] = [rolled(MOTOR.leftWheel, frame), rolled(MOTOR.rightWheel, frame)];
    const turn = (right - left) / TRACK_MM;
    // Both roll along arcs; the robot moves by their chord.
    const chord = ((left + right) / 2) * (turn === 0 ? 1 : Math.sin(turn / 2) / (turn / 2));
    x += chord * Math.cos(heading + turn / 2);
    y += chord * Math.sin(heading + turn / 2);
    heading += turn;
    stands.push({ x, y, heading });
  }
  return stands;
}

/** Evenly between the ends of two frames. */
export function standAt(stands: Stand[], frame: number): Stand {
  const before = stands[Math.min(Math.floor(frame), stands.length - 1)];
  if (!before) return { x: 0, y: 0, heading: 0 };
  const after = stands[Math.floor(frame) + 1] ?? before;
  const mix = (a: number, b: number) => a + (b - a) * (frame - Math.floor(frame));
  return {
    x: mix(before.x, after.x),
    y: mix(before.y, after.y),
    heading: mix(before.heading, after.heading),
  };
}
