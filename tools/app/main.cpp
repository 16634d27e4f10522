// SPDX-License-Identifier: Apache-2.0

// The tetwright program: runs one command and returns its exit status.
#include "tools/app/run_program.h"

int main(int argc, char** argv) { return tetwright::run_program(argc, argv); }
