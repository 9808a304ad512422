// What a program of 32-bit ELF puts where: `[{ address, bytes }]`, by load addresses.

const PT_LOAD = 1;

/** @param {Uint8Array} file */
export function loadedSegments(file) {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  if (view.getUint32(0) !== 0x7f454c46 || file[4] !== 1) {
    throw new Error("not a program of 32-bit ELF");
  }
  const [first, size, count] = [view.getUint32(28, true), view.getUint16(42, true), view.getUint16(44, true)];
  const segments = [];
  for (let header = first; header < first + size * count; header += size) {
    const [type, offset, , address, length] = [0, 4, 8, 12, 16].map((at) => view.getUint32(header + at, true));
    if (type === PT_LOAD && length > 0) {
      segments.push({ address, bytes: file.subarray(offset, offset + length) });
    }
  }
  return segments;
}
