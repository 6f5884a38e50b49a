// Every scanner, compiled whole for a microcontroller; nothing here is run.
#include "driver/device/scan/hub75_scan.h"
#include "driver/device/scan/matrix_scan.h"
#include "driver/device/scan/scan_loop.h"
#include "driver/device/scan/shift_register_scan.h"

namespace xorvox::device {

template class PlaneScanner<Hub75Wires>;
template class PlaneScanner<ShiftRegisterWires>;
template class PlaneScanner<MatrixWires>;
template class ScanLoop<Hub75Scan>;

}  // namespace xorvox::device
