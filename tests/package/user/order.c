/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#include <meshorder.h>
#include <stdio.h>

int main(void) {
  const int32_t offsets[] = {0, 1, 3, 5, 7, 8}, neighbours[] = {2, 3, 4, 0, 3, 1, 2, 1};
  int32_t order[5];
  const mo_in rows = {offsets, 6, MO_INT32}, columns = {neighbours, 8, MO_INT32};
  const mo_out new_to_old = {order, 5, MO_INT32};
  mo_options options;
  mo_options_init(&options, sizeof options);
  options.method = "rcm";
  if (mo_order_graph(&rows, &columns, NULL, NULL, 0, &options, &new_to_old, NULL, NULL) != MO_OK) {
    fprintf(stderr, "%s\n", mo_last_error());
    return 1;
  }
  /* an end of the path 0-2-3-1-4 comes first, its middle in the middle */
  return (order[0] == 0 || order[0] == 4) && order[2] == 3 ? 0 : 2;
}
