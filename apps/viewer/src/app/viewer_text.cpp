// What the viewer says.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/viewer.h"
#include "ui/text.h"

namespace isolux::viewer {
namespace {

constexpr Rgba8 kInk{20, 22, 26, 255};
constexpr Rgba8 kPaper{250, 250, 248, 215};

constexpr double kPad = 4.0;  // round a text, pixels at size 1

std::string short_name(const std::string& name) {
  const std::string file = std::filesystem::path(name).filename().string();
  return file.empty() ? name : file;
}

double label_width(double size, const std::string& text) { return (text_width(text) + 2.0 * kPad) * size; }

/// Text on a light ground, so that it reads over any surface. Returns the height it takes.
double label(Overlay& overlay, double x, double y, double size, const std::string& text) {
  const auto lines = double(1 + std::count(text.begin(), text.end(), '\n'));
  const double pad = kPad * size;
  const double height = (lines * kLineHeight - 2.0) * size + 2.0 * pad;
  overlay.rectangle({x, y, label_width(size, text), height}, kPaper);
  overlay.text(x + pad, y + pad, size, text, kInk);
  return height;
}

/// 1234567 as 1 234 567.
std::string grouped(std::size_t count) {
  std::string digits = std::to_string(count);
  for (int i = int(digits.size()) - 3; i > 0; i -= 3) digits.insert(std::size_t(i), " ");
  return digits;
}

std::string in_words(const LightMemory& memory) {
  if (memory.light == 0) return "";
  const std::string light = fmt::format(" - light of {:.1f} MB", 1e-6 * double(memory.light));
  return memory.light == memory.dense ? light
                                      : light + fmt::format(" in bricks, not {:.1f}", 1e-6 * double(memory.dense));
}

}  // namespace

std::string Viewer::title() const {
  return fmt::format("isolux - {} - isovalue {} - {} triangles in {:.0f} ms - drawn in {:.1f} ms{}",
                     short_name(document_.volume->name()), slider_->text(),
                     grouped(shown_.surface.mesh.triangles.size()), 1e3 * shown_.surface.seconds, 1e3 * draw_seconds_,
                     in_words(renderer_->light_memory()));
}

std::string Viewer::advice() const {
  if (bake_) return "the light is being baked";
  if (wants_exact_) return "exact light is being traced; x stops it";
  return "no light yet: press b for a draft,\nor isolux bake VOLUME -o LIGHT.nrrd and give --light LIGHT.nrrd";
}

std::string Viewer::name_of(const Pane& pane) const {
  if (lighting_of(pane) == Lighting::kLocal) return "local light";
  return shown_.exact ? "global light, exact" : "global light";
}

std::vector<std::string> Viewer::warnings() const {
  std::vector<std::string> result;
  const Surface& surface = shown_.surface;
  if (!surface.error.empty()) {
    result.push_back(surface.error);
  } else if (surface.mesh.triangles.empty() && worker_->idle()) {
    result.emplace_back("no surface at this isovalue");
  }
  if (!document_.light || shown_.exact) return result;
  const LightFile& light = *document_.light->file;
  if (!lit_here()) {
    const ValueRange lit = *light.grid.detail.isovalues;
    result.push_back(
        fmt::format("the light is of isovalues {:.7g} to {:.7g}: local light is shown", lit.low, lit.high));
  }
  return result;
}

std::vector<std::string> Viewer::texts() const {
  std::vector<std::string> result;
  if (bake_) {
    const auto progress = bake_->progress();
    result.push_back(fmt::format("baking a draft: {} {:.0f} %", progress.stage, 100.0 * progress.fraction));
  }
  if (exact_) result.push_back(fmt::format("tracing exact light: {:.0f} %", 100.0 * exact_->progress().fraction));
  if (!message_.empty()) {
    result.push_back(message_);
  } else if (!document_.light && !bake_ && !wants_exact_) {
    result.push_back(advice());
  }
  for (std::string& warning : warnings()) result.push_back(std::move(warning));
  return result;
}

void Viewer::draw_texts(const WindowSize& size) {
  const double font = 1.5 * size.scale;
  const double margin = 10.0 * size.scale;
  double names_end = 0.0;
  for (const Pane& pane : make_panes(layout_, size.width, size.height)) {
    const std::string name = name_of(pane);
    label(overlay_, pane.box.x + margin, margin, font, name);
    names_end = pane.box.x + margin + label_width(font, name);
    if (pane.box.x > 0.0) overlay_.rectangle({pane.box.x - size.scale, 0.0, 2.0 * size.scale, pane.box.height}, kInk);
  }
  const double most = (size.width - 2.0 * margin) / font - 2.0 * kPad;
  double y = margin + 30.0 * size.scale;
  for (const std::string& text : texts())
    y += 4.0 * size.scale + label(overlay_, margin, y, font, wrap_text(text, most));
  const std::string value = "isovalue " + slider_->text();
  const double width = label_width(font, value);
  const double x = std::clamp(slider_->position() - width / 2.0, 0.0, std::max(size.width - width, 0.0));
  label(overlay_, x, slider_->track().y - 64.0 * size.scale, font, value);
  // Left out where it would lie over a name.
  const std::string hint = "h: help";
  const double hint_x = size.width - margin - label_width(font, hint);
  if (!help_ && hint_x > names_end + margin) label(overlay_, hint_x, margin, font, hint);
}

void Viewer::draw_help(const WindowSize& size) {
  std::string names = "drag\nmiddle or shift drag\nwheel or right drag\n";
  std::string helps = "turn\nmove\nnearer or farther\n";
  for (const KeyBinding& binding : key_bindings()) {
    if (binding.name.empty()) continue;
    names += fmt::format("{}\n", binding.name);
    helps += fmt::format("{}\n", binding.help);
  }
  names += "drop a file";
  helps += "look at another volume";
  // At size 1, with a margin all round and a gap between the columns.
  constexpr double kMargin = 13.0;
  const double left = text_width(names);
  const double width = left + text_width(helps) + 3.0 * kMargin;
  const auto lines = double(1 + std::count(names.begin(), names.end(), '\n'));
  const double height = lines * kLineHeight + 2.0 * kMargin;
  const double font = std::min({1.5 * size.scale, size.width / width, size.height / height});
  const Box box{(size.width - width * font) / 2.0, (size.height - height * font) / 2.0, width * font, height * font};
  overlay_.rectangle(box, {250, 250, 248, 240});
  const double x = box.x + kMargin * font;
  const double y = box.y + kMargin * font;
  overlay_.text(x, y, font, names, kInk);
  overlay_.text(x + (left + kMargin) * font, y, font, helps, kInk);
}

}  // namespace isolux::viewer
