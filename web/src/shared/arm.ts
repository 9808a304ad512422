// An arm of two links in the plane, in mm and radians.

export type Point = [number, number];

export interface ArmPose {
  elbow: Point;
  tool: Point;
}

/** Where elbow and tool are: the shoulder turns from the x axis, the elbow from the upper arm. */
export function armPose(linksMm: readonly [number, number], joints: Point): ArmPose {
  const [upperMm, foreMm] = linksMm;
  const [upper, fore] = [joints[0], joints[0] + joints[1]];
  const elbow: Point = [upperMm * Math.cos(upper), upperMm * Math.sin(upper)];
  const tool: Point = [elbow[0] + foreMm * Math.cos(fore), elbow[1] + foreMm * Math.sin(fore)];
  return { elbow, tool };
}

/** Draws the links and the joints in the colour that is set, a pixel of so many mm. */
export function drawLinks(
  context: CanvasRenderingContext2D,
  { elbow, tool }: ArmPose,
  px: number,
): void {
  context.globalAlpha = 0.75;
  context.lineWidth = 7 * px;
  context.beginPath();
  context.moveTo(0, 0);
  context.lineTo(...elbow);
  context.lineTo(...tool);
  context.stroke();
  for (const [x, y] of [[0, 0], elbow] as const) {
    context.beginPath();
    context.arc(x, y, 8 * px, 0, 2 * Math.PI);
    context.fill();
  }
  context.globalAlpha = 1;
}
