// A part of the view (stones and sleepers, or the rail): its geometry, its frames, its colours.
import * as THREE from 'three';
import { floats, indices, quantised } from './decode.js';

export const kinds = ['stone', 'sleeper', 'rail'];

export class Bodies {
  constructor(raw, materials) {
    this.bodies = raw.bodies;
    this.frames = raw.frames;
    this.histories = raw.histories;
    this.rest = floats(raw.points);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(this.rest.slice(), 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(this.rest.length), 3));
    geometry.setIndex(new THREE.BufferAttribute(indices(raw.triangles), 1));
    for (const body of this.bodies) {  // neighbours of a kind are one group
      const last = geometry.groups[geometry.groups.length - 1], material = kinds.indexOf(body.kind);
      const [first, n] = body.triangles;
      if (last && last.materialIndex === material && last.start + last.count === 3 * first) last.count += 3 * n;
      else geometry.addGroup(3 * first, 3 * n, material);
    }
    this.mesh = new THREE.Mesh(geometry, materials);
    this.mesh.frustumCulled = false;
    this.mesh.userData.bodies = this;
  }

  /** Magnitudes of a quantity at the points in a frame. */
  magnitudes(quantity, frame) {
    const values = quantised(this.frames[frame][quantity]);
    if (quantity !== 'displacement') return values;
    const sizes = new Float32Array(values.length / 3);
    for (let i = 0; i < sizes.length; ++i) sizes[i] = Math.hypot(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    return sizes;
  }

  show(frame, quantity, range, exaggeration, palette) {
    const { position, color } = this.mesh.geometry.attributes;
    const moved = quantised(this.frames[frame].displacement);
    for (let i = 0; i < this.rest.length; ++i) position.array[i] = this.rest[i] + exaggeration * (moved[i] || 0);
    const values = this.magnitudes(quantity, frame);
    for (let i = 0; i < values.length; ++i) {
      const level = 3 * Math.round(255 * Math.min(1, (values[i] || 0) / range));
      for (let c = 0; c < 3; ++c) color.array[3 * i + c] = palette[level + c];
    }
    position.needsUpdate = color.needsUpdate = true;
    this.mesh.geometry.computeBoundingSphere();
  }

  /** The body that has a triangle. */
  bodyOf(triangle) {
    return this.bodies.findIndex(({ triangles: [first, n] }) => triangle >= first && triangle < first + n);
  }

  box(kind) {
    const box = new THREE.Box3(), point = new THREE.Vector3();
    for (const body of this.bodies.filter((one) => kind === undefined || one.kind === kind)) {
      for (let i = body.points[0]; i < body.points[0] + body.points[1]; ++i) box.expandByPoint(point.fromArray(this.rest, 3 * i));
    }
    return box;
  }

  /** The triangles of one body where they are now, for its outline. */
  outline(index) {
    const [first, n] = this.bodies[index].triangles;
    const { position } = this.mesh.geometry.attributes, triangles = this.mesh.geometry.index.array;
    const points = new Float32Array(18 * n);
    for (let t = 0; t < n; ++t) {
      for (let edge = 0; edge < 3; ++edge) {
        for (let end = 0; end < 2; ++end) {
          const point = triangles[3 * (first + t) + ((edge + end) % 3)];
          for (let c = 0; c < 3; ++c) points[18 * t + 6 * edge + 3 * end + c] = position.array[3 * point + c];
        }
      }
    }
    return points;
  }
}
