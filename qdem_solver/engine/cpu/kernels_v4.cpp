#define QDEM_KERNELS kernels_v4
#define QDEM_KERNEL_WIDTH 8
#define QDEM_INSTRUCTION_SET "x86-64-v4"
#include "qdem_solver/engine/cpu/kernels_body.hpp"
