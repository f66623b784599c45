// The 3-D view: what is where on the screen. What it shows is set by view_panel.js.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Bodies, kinds } from './bodies.js';
import { colours } from './colour_map.js';
import { theme } from './dom.js';

const axes = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

export class Scene {
  /** Throws where there is no WebGL. */
  constructor(raw, canvas, wheel) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.scene = new THREE.Scene();
    this.plane = new THREE.Plane();
    this.materials = kinds.map(() => new THREE.MeshLambertMaterial({ vertexColors: true, flatShading: true, side: THREE.DoubleSide }));
    this.parts = raw.parts.map((part) => new Bodies(part, this.materials));
    this.times = raw.frames;
    this.scene.add(...this.parts.map((part) => part.mesh));
    this.addLights();
    this.box = this.parts[0].box();
    this.addWheel(wheel);
    this.outline = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xff3b6b, depthTest: false, transparent: true }));
    this.outline.frustumCulled = false;
    this.scene.add(this.outline);
    this.selected = null;
    this.camera = new THREE.PerspectiveCamera(38, 1, 0.01, 200);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.render());
    this.controls.enableZoom = false;  // until the view has the focus: the page must scroll under the pointer
    canvas.addEventListener('focus', () => { this.controls.enableZoom = true; });
    canvas.addEventListener('blur', () => { this.controls.enableZoom = false; });
    this.home();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  addLights() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xa0a0ac, 2.9));
    const sun = new THREE.DirectionalLight(0xffffff, 1.9);
    sun.position.set(-2, -3, 4);
    this.scene.add(sun);
  }

  /** wheel: { radius, x(time), dz(time) }: a disc on the rail. */
  addWheel(wheel) {
    const rail = this.parts.find((part) => part.bodies[0].kind === 'rail');
    if (!wheel || !rail) return;
    const box = rail.box(), { radius } = wheel;
    const tyre = new THREE.CylinderGeometry(radius, radius, 0.1, 72);
    this.wheel = new THREE.Mesh(tyre, new THREE.MeshLambertMaterial({ color: 0x8d99a6, transparent: true, opacity: 0.55 }));
    this.wheel.add(new THREE.LineSegments(new THREE.EdgesGeometry(tyre, 30), new THREE.LineBasicMaterial({ color: 0x4a5560 })));
    this.wheel.position.set(0, (box.min.y + box.max.y) / 2, box.max.z + radius);
    this.wheelPath = { ...wheel, z: box.max.z + radius };
    this.scene.add(this.wheel);
  }

  home() {
    const centre = this.box.getCenter(new THREE.Vector3()), size = this.box.getSize(new THREE.Vector3()).length();
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(new THREE.Vector3(-0.85, -1.0, 0.75).multiplyScalar(0.9 * size));
    this.controls.update();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  render() {
    this.renderer.setClearColor(new THREE.Color(theme('--stage')));
    this.renderer.render(this.scene, this.camera);
  }

  /** state: { frame, quantity, range, exaggeration, map, hidden: Set of kinds, cut: { axis, share } } */
  show(state) {
    const palette = colours(state.map), colour = new THREE.Color();
    for (let i = 0; i < palette.length; i += 3) colour.setRGB(palette[i], palette[i + 1], palette[i + 2], THREE.SRGBColorSpace).toArray(palette, i);
    for (const part of this.parts) part.show(state.frame, state.quantity, state.range, state.exaggeration, palette);
    this.cut(state.cut);
    this.materials.forEach((material, i) => { material.visible = !state.hidden.has(kinds[i]); });
    if (this.wheel) {
      const time = this.times[state.frame];
      this.wheel.visible = !state.hidden.has('rail');
      this.wheel.position.x = this.wheelPath.x(time);
      this.wheel.position.z = this.wheelPath.z + state.exaggeration * this.wheelPath.dz(time);
      this.wheel.rotation.y = this.wheelPath.x(time) / this.wheelPath.radius;
    }
    this.drawOutline();
    this.render();
  }

  cut({ axis, share }) {
    const planes = axis === 'none' ? [] : [this.plane];
    if (planes.length) {
      const low = this.box.min[axis], high = this.box.max[axis];
      this.plane.normal.set(...axes[axis]).negate();
      this.plane.constant = low + share * (high - low);
      if (axis !== 'z') {  // what lies on the viewer's side of the first picture is cut away
        this.plane.normal.negate();
        this.plane.constant = -this.plane.constant;
      }
    }
    for (const material of this.materials) material.clippingPlanes = planes;
  }

  /** The body under a place of the canvas in 0..1: { part, body }, or null. */
  pick(x, y) {
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * x - 1, 1 - 2 * y), this.camera);
    const planes = this.materials[0].clippingPlanes;
    for (const hit of ray.intersectObjects(this.parts.map((part) => part.mesh), false)) {
      const bodies = hit.object.userData.bodies, body = bodies.bodyOf(hit.faceIndex);
      const visible = this.materials[kinds.indexOf(bodies.bodies[body].kind)].visible;
      if (visible && planes.every((plane) => plane.distanceToPoint(hit.point) >= 0)) return { part: bodies, body };
    }
    return null;
  }

  select(selected) {
    this.selected = selected;
    this.drawOutline();
    this.render();
  }

  drawOutline() {
    this.outline.visible = this.selected !== null;
    if (!this.selected) return;
    const points = this.selected.part.outline(this.selected.body);
    this.outline.geometry.setAttribute('position', new THREE.BufferAttribute(points, 3));
  }

  /** Turns the camera about its target by angles [rad] and multiplies its distance. */
  orbit(azimuth, elevation, distance) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const sphere = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    sphere.theta += azimuth;
    sphere.phi = Math.min(3.1, Math.max(0.04, sphere.phi + elevation));
    sphere.radius *= distance;
    const turned = new THREE.Vector3().setFromSpherical(sphere);
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    this.controls.update();
    this.render();
  }
}
