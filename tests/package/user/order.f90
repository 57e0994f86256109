! Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
! The path 0-2-3-1-4 in the order of the default method; the numbers of all vertices come out.
program order
  use, intrinsic :: iso_c_binding
  implicit none

  type, bind(c) :: mo_array  ! mo_in and mo_out
    type(c_ptr) :: data
    integer(c_int64_t) :: size
    integer(c_int32_t) :: type
  end type

  interface
    function mo_order_graph(offsets, neighbours, weights, points, dimension, options, new_to_old, old_to_new, &
                            result) result(status) bind(c, name="mo_order_graph")
      import :: c_int32_t, c_ptr, mo_array
      type(mo_array), intent(in) :: offsets, neighbours, new_to_old
      type(c_ptr), value :: weights, points, options, old_to_new, result
      integer(c_int32_t), value :: dimension
      integer(c_int32_t) :: status
    end function
  end interface

  integer(c_int32_t), parameter :: mo_int32 = 0
  integer(c_int32_t), target :: offsets(6) = [0, 1, 3, 5, 7, 8]
  integer(c_int32_t), target :: neighbours(8) = [2, 3, 4, 0, 3, 1, 2, 1]
  integer(c_int32_t), target :: places(5) = -1
  integer :: v

  if (mo_order_graph(mo_array(c_loc(offsets), 6_c_int64_t, mo_int32), mo_array(c_loc(neighbours), 8_c_int64_t, mo_int32), &
                     c_null_ptr, c_null_ptr, 0, c_null_ptr, mo_array(c_loc(places), 5_c_int64_t, mo_int32), &
                     c_null_ptr, c_null_ptr) /= 0) stop 1
  do v = 0, 4
    if (count(places == v) /= 1) stop 2
  end do
end program
