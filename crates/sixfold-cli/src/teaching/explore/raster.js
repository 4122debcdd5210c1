// Draws triangles and lines into an image: a depth buffer, and for each pixel the face that is seen.
//
// Own drawing instead of WebGL: the meshes are small, the page needs the face below the pointer and the depth at any
// pixel anyway, and it looks the same on every machine, also without a graphics card.

// A value of Image.face where no face is seen.
export const NO_FACE = 0xffffffff;

export class Raster {
  resize(width, height) {
    if (this.width === width && this.height === height) return;
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    // 1 / distance from the eye: large is near.
    this.depth = new Float32Array(width * height);
    this.face = new Uint32Array(width * height);
  }

  clear(colour) {
    this.pixels.fill(colour);
    this.depth.fill(0);
    this.face.fill(NO_FACE);
  }

  // Fills a triangle. x and y are in pixels, d is the depth, colour is ABGR.
  triangle(ax, ay, ad, bx, by, bd, cx, cy, cd, face, colour) {
    const { width, height, depth, pixels } = this;
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) return;
    const left = Math.max(0, Math.ceil(Math.min(ax, bx, cx) - 0.5));
    const right = Math.min(width - 1, Math.floor(Math.max(ax, bx, cx) - 0.5));
    const top = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
    const bottom = Math.min(height - 1, Math.floor(Math.max(ay, by, cy) - 0.5));
    if (left > right || top > bottom) return;
    // The weights of b and c, and the depth, are linear in x and y.
    const u0 = (cy - ay) / area, u1 = -(cx - ax) / area;
    const v0 = -(by - ay) / area, v1 = (bx - ax) / area;
    const dx = u0 * (bd - ad) + v0 * (cd - ad);
    const dy = u1 * (bd - ad) + v1 * (cd - ad);
    for (let y = top; y <= bottom; y += 1) {
      const py = y + 0.5 - ay;
      let px = left + 0.5 - ax;
      let u = u0 * px + u1 * py;
      let v = v0 * px + v1 * py;
      let d = ad + dx * px + dy * py;
      let i = y * width + left;
      for (let x = left; x <= right; x += 1) {
        if (u >= 0 && v >= 0 && u + v <= 1 && d > depth[i]) {
          depth[i] = d;
          pixels[i] = colour;
          this.face[i] = face;
        }
        u += u0;
        v += v0;
        d += dx;
        i += 1;
      }
    }
  }

  // Draws a line of about `thickness` pixels where no face is before it.
  line(ax, ay, ad, bx, by, bd, colour, thickness) {
    const steep = Math.abs(by - ay) > Math.abs(bx - ax);
    if (steep) [ax, ay, bx, by] = [ay, ax, by, bx];
    if (ax > bx) [ax, ay, ad, bx, by, bd] = [bx, by, bd, ax, ay, ad];
    const [across, along] = steep ? [this.width, this.height] : [this.height, this.width];
    const slope = bx - ax > 1e-6 ? (by - ay) / (bx - ax) : 0;
    const fall = bx - ax > 1e-6 ? (bd - ad) / (bx - ax) : 0;
    const half = (thickness / 2) * Math.hypot(1, slope);
    const last = Math.min(along - 1, Math.floor(bx));
    for (let x = Math.max(0, Math.floor(ax)); x <= last; x += 1) {
      const centre = ay + (x + 0.5 - ax) * slope;
      // A line is a little nearer than the faces beside it.
      const d = (ad + (x + 0.5 - ax) * fall) * 1.004;
      const first = Math.max(0, Math.floor(centre - half));
      const end = Math.min(across - 1, Math.floor(centre + half));
      for (let y = first; y <= end; y += 1) {
        const cover = Math.min(y + 1, centre + half) - Math.max(y, centre - half);
        const i = steep ? x * this.width + y : y * this.width + x;
        if (cover > 0 && d > this.depth[i]) this.pixels[i] = blend(this.pixels[i], colour, Math.min(1, cover));
      }
    }
  }

  // The depth of the nearest face at a pixel; 0 where there is none.
  depthAt(x, y) {
    const inside = x >= 0 && y >= 0 && x < this.width && y < this.height;
    return inside ? this.depth[Math.floor(y) * this.width + Math.floor(x)] : 0;
  }

  // The face at a pixel, or null.
  faceAt(x, y) {
    if (x < 0 || y < 0 || x >= this.width || y >= this.height) return null;
    const face = this.face[Math.floor(y) * this.width + Math.floor(x)];
    return face === NO_FACE ? null : face;
  }
}

function blend(below, above, cover) {
  const part = Math.round(cover * 256);
  const odd = (((below & 0xff00ff) * (256 - part) + (above & 0xff00ff) * part) >>> 8) & 0xff00ff;
  const even = (((below >>> 8) & 0xff) * (256 - part) + ((above >>> 8) & 0xff) * part) & 0xff00;
  return (0xff000000 | odd | even) >>> 0;
}

// A colour #rrggbb, made darker or lighter, as the number of a pixel.
export function pixel(hex, light = 1) {
  const part = (from) => Math.min(255, Math.round(parseInt(hex.slice(from, from + 2), 16) * light));
  return ((255 << 24) | (part(5) << 16) | (part(3) << 8) | part(1)) >>> 0;
}
