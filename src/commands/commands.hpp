#pragma once

#include "cli/command.hpp"

/// One function a command, each in the file of its name.

namespace thermfit::cli {

Command check_command();
Command rank_command();
Command fit_command();
Command predict_command();
Command study_command();
Command inspect_command();
Command simulate_command();
Command calibrate_command();
Command diagnose_command();
Command run_command();
Command export_command();

}  // namespace thermfit::cli
