"""What people see: pictures, reports, a progress bar."""
