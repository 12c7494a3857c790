! Boxes that needles have crossed go on from an array of Fortran, image(3, N).
program images
  use needlework
  implicit none
  integer, parameter :: n = 2
  character(len=*), parameter :: scene = c_null_char
  integer(c_int32_t), target :: image(3, n) = &
    reshape([7, -8, 9, -2147481599, 0, 2147481599], [3, n])
  real(c_double), target :: position(3, n), velocity(3, n), director(3, n)
  type(needlework_initial) :: initial
  type(needlework_state) :: into
  type(needlework_limits) :: limits
  type(needlework_error) :: error
  type(c_ptr) :: gas, counted_anew
  integer(c_int) :: stopped

  ! The first needle leaves the box upwards along x and downwards along z; the second rests.
  position = reshape([4d0, 1d0, 1d0, 2d0, 3d0, 3d0], [3, n])
  velocity = reshape([2d0, 0d0, -2d0, 0d0, 0d0, 0d0], [3, n])
  director = reshape([0d0, 1d0, 0d0, 1d0, 0d0, 0d0], [3, n])
  initial%count = n
  initial%box = 5
  initial%position = rows_of(position)
  initial%velocity = rows_of(velocity)
  initial%orientation = rows_of(director)
  gas = needlework_create_with_images(scene, initial, image, 0_c_int, error)
  if (.not. c_associated(gas)) then
    print '(a)', text_of(error%message)
    stop 1
  end if
  counted_anew = needlework_create_with_images(scene, initial, flags=0_c_int)
  if (.not. c_associated(counted_anew)) stop 1
  call needlework_destroy(counted_anew)
  limits%time = 1
  if (needlework_run_until(gas, limits, stopped) /= needlework_ok) then
    print '(a)', needlework_text(needlework_message(gas))
    stop 1
  end if
  into%position = rows_of(position)
  into%image = c_loc(image)
  if (needlework_get_state(gas, into) /= needlework_ok) stop 1
  print '(a, 3(1x, i0))', 'images of the first needle', image(:, 1)
  print '(a, 3(1x, i0))', 'images of the second needle', image(:, 2)
  print '(a, 3f8.4)', 'the first needle is now at', position(:, 1)
  call needlework_destroy(gas)

  image(2, 2) = ibset(image(2, 2), 31)  ! of 0: -2147483648, which has no opposite
  gas = needlework_create_with_images(scene, initial, image, 0_c_int, error)
  if (c_associated(gas)) stop 1
  print '(a)', text_of(error%message)
end program
