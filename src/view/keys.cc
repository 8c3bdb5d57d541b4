#include "src/view/keys.h"

namespace sheaf {
namespace {

constexpr Action ShowAction(int shown) {
  return static_cast<Action>(static_cast<int>(Action::kShowFirst) + shown);
}

constexpr Key kKeys[] = {
    {kKeyF1, "F1", ShowAction(0), "show colours"},
    {kKeyF1 + 1, "F2", ShowAction(1), "show depth"},
    {kKeyF1 + 2, "F3", ShowAction(2), "show normals"},
    {kKeyF1 + 3, "F4", ShowAction(3), "show albedo"},
    {kKeyF1 + 4, "F5", ShowAction(4), "show objects"},
    {kKeyF1 + 5, "F6", ShowAction(5), "show heat: time red, live lanes green, rays blue"},
    {kKeyF1 + 6, "F7", ShowAction(6), "show lane use: white where all lanes are live"},
    {'N', "N", Action::kNextCamera, "next camera"},
    {'B', "B", Action::kPreviousCamera, "camera before"},
    {'V', "V", Action::kNextView, "next view, whose cameras N and B go through"},
    {'R', "R", Action::kReset, "camera back to where the scene has it"},
    {'T', "T", Action::kNextTarget, "next target"},
    {'G', "G", Action::kBeside, "scalar baseline on the right half, on and off"},
    {'=', "=", Action::kBrighter, "brighter by a third of a stop"},
    {'-', "-", Action::kDarker, "darker by a third of a stop"},
    {'M', "M", Action::kMeter, "exposure that makes the median grey"},
    {']', "]", Action::kMoreSamples, "twice the samples"},
    {'[', "[", Action::kFewerSamples, "half the samples"},
    {',', ",", Action::kNarrower, "narrower angle"},
    {'.', ".", Action::kWider, "wider angle"},
    {'P', "P", Action::kSavePicture, "save the picture"},
    {'K', "K", Action::kSaveCamera, "save the camera as JSON"},
    {'H', "H", Action::kPanel, "panel on and off"},
    {kKeyTab, "Tab", Action::kPanel, "panel on and off"},
    {kKeyEscape, "Escape", Action::kClose, "close"},
};

constexpr Motion kMotions[] = {
    {"left drag", "orbit about what the camera looks at"},
    {"right drag", "look around"},
    {"middle drag", "move across the picture"},
    {"wheel", "nearer and farther"},
    {"W A S D", "fly ahead, left, back, right; with shift four times as fast"},
    {"E Q", "fly up, down"},
    {"click", "pick a pixel: object, t, normal, rays"},
};

}  // namespace

std::span<const Key> Keys() { return kKeys; }
std::span<const Motion> Motions() { return kMotions; }

}  // namespace sheaf
