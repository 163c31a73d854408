#pragma once

/// A fitted model as source for what runs in a machine. Each target is one function in a file of its own.

#include <string>
#include <vector>

#include "thermfit/controller/settings_for.hpp"

namespace thermfit::cli {

/// The unit of the exported offset, written out in names and comments.
struct OffsetUnit {
  std::string name;        ///< "um", "mm", "0.1 um"
  std::string identifier;  ///< "um", "mm", "tenth_um"
  double per_um = 1;
};
/// "um", "mm" or "0.1um"; throws Error otherwise.
OffsetUnit offset_unit(const std::string& name);

struct ExportRequest {
  TrainedModel trained;
  std::string source;            ///< the model file
  std::string name = "thermal";  ///< an identifier; prefixes all that is exported
  CompensationWishes wishes;
  bool single_precision = false;
  OffsetUnit unit;
  std::string control;  ///< of a card
};

using ControllerSource = std::string;
ControllerSource export_c(const ExportRequest& request);       ///< C99 header with test vectors
ControllerSource export_cpp(const ExportRequest& request);     ///< C++17 header for thermfit/controller
ControllerSource export_st(const ExportRequest& request);      ///< IEC 61131-3 function block and its test
ControllerSource export_linuxcnc(const ExportRequest& given);  ///< HAL component
ControllerSource export_onnx(const ExportRequest& request);    ///< bare model as ONNX, binary
ControllerSource export_card(const ExportRequest& request);    ///< how to enter it by hand, per control

std::vector<std::string> card_controls();
/// The unit that a control counts offsets in; "um" for an unknown one.
std::string card_unit(const std::string& control);

}  // namespace thermfit::cli
