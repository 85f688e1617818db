#version 330 core

layout(location = 0) in vec2 position;  // window pixels, y downwards
layout(location = 1) in vec4 colour;

uniform vec2 window_size;

out vec4 shade;

void main() {
  shade = colour;
  vec2 clip = 2.0 * position / window_size - 1.0;
  gl_Position = vec4(clip.x, -clip.y, 0.0, 1.0);
}
