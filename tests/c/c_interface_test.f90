! Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
! A caller in Fortran, with arrays that count from 1.
module meshorder_of_c
  use, intrinsic :: iso_c_binding
  implicit none

  integer(c_int32_t), parameter :: mo_ok = 0
  integer(c_int32_t), parameter :: mo_invalid_argument = 1
  integer(c_int32_t), parameter :: mo_int32 = 0
  integer(c_int32_t), parameter :: mo_int64 = 2

  type, bind(c) :: mo_array  ! mo_in and mo_out
    type(c_ptr) :: data = c_null_ptr
    integer(c_int64_t) :: size = 0
    integer(c_int32_t) :: type = mo_int32
  end type

  type, bind(c) :: mo_options
    integer(c_size_t) :: struct_size
    type(c_ptr) :: method
    type(c_ptr) :: element_method
    type(c_ptr) :: workload
    integer(c_int64_t) :: seed
    real(c_double) :: tolerance
    real(c_double) :: time_limit
    integer(c_int32_t) :: threads
    integer(c_int32_t) :: base
    integer(c_int32_t) :: check
    integer(c_int32_t) :: symmetrize
    type(mo_array) :: start
    type(mo_array) :: groups
    type(c_funptr) :: progress
    type(c_ptr) :: user
    integer(c_int32_t) :: max_iterations
    integer(c_int32_t) :: reserved
    type(mo_array) :: cell_groups
  end type

  interface
    subroutine mo_options_init(options, struct_size) bind(c, name="mo_options_init")
      import :: c_size_t, mo_options
      type(mo_options), intent(out) :: options
      integer(c_size_t), value :: struct_size
    end subroutine

    function mo_order_graph(offsets, neighbours, weights, points, dimension, options, new_to_old, old_to_new, &
                            result) result(status) bind(c, name="mo_order_graph")
      import :: c_int32_t, c_ptr, mo_array, mo_options
      type(mo_array), intent(in) :: offsets
      type(mo_array), intent(in) :: neighbours
      type(c_ptr), value :: weights
      type(c_ptr), value :: points
      integer(c_int32_t), value :: dimension
      type(mo_options), intent(in) :: options
      type(mo_array), intent(in) :: new_to_old
      type(mo_array), intent(in) :: old_to_new
      type(c_ptr), value :: result
      integer(c_int32_t) :: status
    end function

    function mo_move(new_to_old, base, from, to, row_bytes) result(status) bind(c, name="mo_move")
      import :: c_int32_t, c_int64_t, c_ptr, mo_array
      type(mo_array), intent(in) :: new_to_old
      integer(c_int32_t), value :: base
      type(c_ptr), value :: from
      type(c_ptr), value :: to
      integer(c_int64_t), value :: row_bytes
      integer(c_int32_t) :: status
    end function
  end interface
end module

program c_interface_test
  use meshorder_of_c
  implicit none

  ! the path 1 - 4 - 2 - 5 - 3
  integer, parameter :: n = 5
  integer(c_int32_t), target :: offsets(n + 1) = [1, 2, 4, 5, 7, 9]
  integer(c_int32_t), target :: neighbours(8) = [4, 4, 5, 5, 1, 2, 2, 3]
  integer(c_int32_t), target :: new_to_old(n)
  integer(c_int64_t), target :: old_to_new(n)
  real(c_double), target :: field(2, n), moved(2, n)
  character(kind=c_char), target :: method(4) = [character(kind=c_char) :: 'r', 'c', 'm', c_null_char]
  type(mo_options) :: options
  type(mo_array) :: order
  integer :: k, v

  call mo_options_init(options, c_sizeof(options))
  options%method = c_loc(method)
  options%base = 1
  order = mo_array(c_loc(new_to_old), n, mo_int32)
  if (mo_order_graph(mo_array(c_loc(offsets), n + 1, mo_int32), mo_array(c_loc(neighbours), 8, mo_int32), &
                     c_null_ptr, c_null_ptr, 0, options, order, mo_array(c_loc(old_to_new), n, mo_int64), &
                     c_null_ptr) /= mo_ok) error stop "the order failed"

  do k = 1, n
    if (new_to_old(k) < 1 .or. new_to_old(k) > n) error stop "a number is out of range"
    if (old_to_new(new_to_old(k)) /= k) error stop "the maps are not inverse"
  end do
  do v = 1, n
    do k = offsets(v), offsets(v + 1) - 1
      if (abs(old_to_new(v) - old_to_new(neighbours(k))) /= 1) error stop "neighbours are apart"
    end do
  end do

  do v = 1, n
    field(:, v) = [real(v, c_double), -real(v, c_double)]
  end do
  if (mo_move(order, 1, c_loc(field), c_loc(moved), int(2 * c_sizeof(field(1, 1)), c_int64_t)) /= mo_ok) then
    error stop "the move failed"
  end if
  if (any(abs(moved - field(:, new_to_old)) > 0)) error stop "rows are at wrong places"

  options%base = 0
  if (mo_order_graph(mo_array(c_loc(offsets), n + 1, mo_int32), mo_array(c_loc(neighbours), 8, mo_int32), &
                     c_null_ptr, c_null_ptr, 0, options, order, mo_array(c_loc(old_to_new), n, mo_int64), &
                     c_null_ptr) /= mo_invalid_argument) error stop "the wrong base was not refused"
end program
